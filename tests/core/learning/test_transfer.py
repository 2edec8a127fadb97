"""Transfer over a lifetime: by hand and by slow twins."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.core import InputError, lifetime_transfer, mean_estimate

LIFE = np.array([[1, 2, 4], [8, 4, 2], [6, 8, 4], [7, 4, 8]], float)
"""Before anything, then after tasks 0, 1 and 2; columns are the tasks."""
lives = arrays(float, (5, 4), elements=st.integers(1, 40).map(float))


def test_differences_by_hand():
    found = lifetime_transfer([LIFE])
    assert found.average_performance.value == pytest.approx(19 / 3)
    assert found.forward_transfer.value == 1.0  # task 1: 4 - 2 before it is learnt; task 2: 4 - 4
    assert found.backward_transfer.value == -2.5  # 7 - 8 and 4 - 8
    assert found.forgetting.value == 2.5  # best after an earlier task: 8 of task 0, 8 of task 1
    assert found.performance_maintenance.value == -2.75  # task 0: mean of -2 and -1; task 1: -4; L2Metrics's too


def slow(life: np.ndarray) -> dict[str, float]:
    """The measures as they are written, task by task; R_{i, j} is `life[i]`, tasks from 1."""
    n = life.shape[1]
    r = {(i, j): life[i, j - 1] for i in range(n + 1) for j in range(1, n + 1)}
    kept = [[r[k, j] - r[j, j] for k in range(j + 1, n + 1)] for j in range(1, n)]
    return {
        "average_performance": sum(r[n, j] for j in range(1, n + 1)) / n,
        "forward_transfer": sum(r[j - 1, j] - r[0, j] for j in range(2, n + 1)) / (n - 1),
        "backward_transfer": sum(r[n, j] - r[j, j] for j in range(1, n)) / (n - 1),
        "forgetting": sum(max(r[k, j] for k in range(1, n)) - r[n, j] for j in range(1, n)) / (n - 1),
        "performance_maintenance": sum(sum(one) / len(one) for one in kept) / len(kept),
    }


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(lives, lives)
def test_lives_are_measured_one_by_one(one, other):
    found, twins = lifetime_transfer([one, other, one]), [slow(one), slow(other), slow(one)]
    for name in twins[0]:
        assert getattr(found, name).value == pytest.approx(np.mean([twin[name] for twin in twins]))
    paired = lifetime_transfer([one, other], [other, one])
    assert all(getattr(paired, name).value == pytest.approx(0) for name in twins[0])
    assert lifetime_transfer([one], [other]).forgetting.value == pytest.approx(
        twins[0]["forgetting"] - twins[1]["forgetting"]
    )


def test_plain_data_has_an_interval_of_each_measure():
    lives = [LIFE, LIFE * 2, LIFE * 3]
    plain = lifetime_transfer(lives).to_dict()
    assert plain["forgetting"] == mean_estimate([2.5, 5.0, 7.5]).to_dict()
    assert plain["forgetting"]["ci95"] is not None


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: lifetime_transfer(LIFE), r"must be \(n_lives, n_tasks \+ 1, n_tasks\).*got \(4, 3\)"),
        (lambda: lifetime_transfer(np.zeros((1, 2, 1))), "at least two tasks"),
        (lambda: lifetime_transfer(np.full((1, 3, 2), np.nan)), "must be finite"),
        (lambda: lifetime_transfer([LIFE], [LIFE, LIFE]), r"same lives, \(1, 4, 3\), got \(2, 4, 3\)"),
    ],
)
def test_arguments_that_break_a_rule(call, words):
    with pytest.raises(InputError, match=words):
        call()
