"""Which actions count: ties and their tolerance, goals, and states a learner never came to."""

import numpy as np
import pytest

from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.core.errors import InputError

Q = np.array([[1.0, 1.0 - 5e-10, 0.0], [2.0, 0.0, 2.1], [0.0, 0.0, 0.0], [-1.0, -3.0, -1.0]])


def test_exact_values_by_hand():
    best = [[True, True, False], [False, False, True], [True, True, True], [True, False, True]]
    assert actions_to_count(Q, "all").tolist() == best
    best[2] = [False, False, False]
    assert actions_to_count(Q, "all", ended=[False, False, True, False]).tolist() == best


def test_the_tolerance_is_relative_to_the_best():
    assert actions_to_count(Q, "all", tolerance=0.0)[0].tolist() == [True, False, False]
    assert actions_to_count(Q, "all", tolerance=0.05)[1].tolist() == [True, False, True]  # 2.1 - 0.105 ≤ 2
    assert actions_to_count(1e6 * Q, "all", tolerance=0.05)[1].tolist() == [True, False, True]


def test_learnt_values_by_hand():
    visits = np.array([[1, 0, 0], [3, 1, 0], [9, 9, 9], [1, 1, 1]])
    # Row 0: the tied action was never tried. Row 1: nor was the one that looks best. Row 2 learnt nothing.
    best = [[True, False, False], [True, False, False], [False] * 3, [True, False, True]]
    assert actions_to_count(Q, "visited", visits=visits).tolist() == best
    never = actions_to_count(Q, "visited", visits=np.zeros_like(visits))
    assert not never.any()
    ended = actions_to_count(Q, "visited", visits=visits, ended=[True, False, False, False])
    assert ended.tolist() == [[False] * 3, *best[1:]]


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"over": "visited"}, r"'visited' needs visits of shape \(4, 3\), got \(0,\)"),
        ({"over": "visited", "visits": [[1]]}, r"got \(1, 1\)"),
        ({"over": "all", "ended": [True]}, r"ended must have shape \(4,\), got \(1,\)"),
        ({"over": "all", "tolerance": -1.0}, "tolerance must be finite and at least 0, got -1.0"),
    ],
)
def test_broken_rules(told, message):
    with pytest.raises(InputError, match=message):
        actions_to_count(Q, **told)
