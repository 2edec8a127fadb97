"""Streams of tasks: frequencies by hand, late types, random access."""

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
    usual = np.mean([task.hidden_type == jobs.usual_type(task.context) for task in drawn])
    assert usual == pytest.approx(0.7 + 0.3 / 4, abs=0.037)
    assert len({jobs.usual_type(context) for context in range(3)}) == 3


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
    [{"n_contexts": 0}, {"loyalty": 1.5}, {"arrivals": {"z": 3}}, {"arrivals": {"a": 3, "b": 3}}, {"zipf": -1.0}],
)
def test_wrong_settings_are_refused(wrong):
    with pytest.raises(InputError):
        TaskStream(TYPES, **wrong)
