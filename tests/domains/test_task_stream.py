"""Streams of tasks: frequencies by hand, late types, changes, random access."""

import itertools

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.task_stream import TaskStream

TYPES = ("a", "b", "c", "d")


def test_contexts_follow_zipf_and_tasks_their_contexts():
    jobs = TaskStream(TYPES, seed=3, n_contexts=3, zipf=1.0, loyalty=0.7)
    drawn = [jobs.draw(k) for k in range(3000)]
    shares = np.bincount([task.context for task in drawn]) / 3000
    # Shares 6 : 3 : 2; four standard errors are at most 4 * 0.5 / sqrt(3000) = 0.037.
    assert shares == pytest.approx([6 / 11, 3 / 11, 2 / 11], abs=0.037)
    usual = np.mean([task.hidden_type == jobs.usual_type(task.context, task.number) for task in drawn])
    assert usual == pytest.approx(0.7 + 0.3 / 4, abs=0.037)
    assert len({jobs.usual_type(context, 0) for context in range(3)}) == 3


def test_a_task_depends_on_its_number_alone():
    jobs = TaskStream(TYPES)
    assert [jobs.draw(k) for k in (5, 2)] == [[jobs.draw(k) for k in range(6)][k] for k in (5, 2)]
    assert [jobs.draw(k) for k in range(9)] != [TaskStream(TYPES, seed=1).draw(k) for k in range(9)]


def test_a_late_type_arrives_on_time_and_no_sooner():
    jobs = TaskStream(TYPES, arrivals={"c": 20}, n_contexts=6)
    drawn = [jobs.draw(k).hidden_type for k in range(200)]
    assert "c" not in drawn[:20]
    assert drawn[20] == "c"
    assert "c" in drawn[21:]


@pytest.mark.parametrize(
    "wrong",
    [
        {"n_contexts": 0},
        {"loyalty": 1.5},
        {"arrivals": {"z": 3}},
        {"arrivals": {"a": 3, "b": 3}},
        {"zipf": -1.0},
        {"change": 1.1},
    ],
)
def test_wrong_settings_are_refused(wrong):
    with pytest.raises(InputError):
        TaskStream(TYPES, **wrong)


def test_the_type_changes_between_episodes_as_often_as_stated():
    jobs, still = TaskStream(TYPES, seed=3, loyalty=0.5, change=0.2), TaskStream(TYPES, seed=3, loyalty=0.5)
    rows = [[jobs.draw(k, episode=e).hidden_type for e in range(6)] for k in range(300)]
    assert [row[0] for row in rows] == [still.draw(k).hidden_type for k in range(300)]
    assert len({still.draw(7, episode=e) for e in range(6)}) == 1
    changed = [a != b for row in rows for a, b in itertools.pairwise(row)]
    # Four standard errors of 1500 draws are 4 * sqrt(0.2 * 0.8 / 1500) = 0.041.
    assert np.mean(changed) == pytest.approx(0.2, abs=0.041)
    # From a type that is not usual: 0.5 + 0.125 usual, 0.125 each of two others.
    following = [
        (jobs.usual_type(jobs.draw(k).context, k), b)
        for k, row in enumerate(rows)
        for a, b in itertools.pairwise(row)
        if a != b and a != jobs.usual_type(jobs.draw(k).context, k)
    ]
    usual = np.mean([b == name for name, b in following])
    assert usual == pytest.approx(0.625 / 0.875, abs=4 * 0.5 / len(following) ** 0.5)
