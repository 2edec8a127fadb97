"""Experts' ways to goals: counts, steps to go, and ways extend_goal_models together."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.action.advice.goal_model import GoalModel, Trajectory, extend_goal_models
from lifelore.core.errors import InputError

EAST, WEST = 0, 1
LINE = np.array([[1, -1], [2, 0], [3, 1], [4, 2], [-1, 3]])
"""Five places in a row."""


def walk(states, actions):
    return Trajectory(np.array(states), np.array(actions))


def test_counts_and_steps_by_hand():
    ways = [walk([0, 1, 2], [EAST, EAST]), walk([1, 1, 1, 2], [WEST, -1, EAST])]
    purpose = GoalModel.from_trajectories(ways, 5, 2, goals=[2])
    # State 1: east with 1 step to go, west with 3, east with 1; the song (-1) on the way counts for nothing.
    assert purpose.prior.counts([0, 1, 2]).tolist() == [[1, 0], [2, 1], [0, 0]]
    assert purpose.steps.tolist() == [2, 5 / 3, np.inf, np.inf, np.inf]
    assert purpose.theta[[0, 1, 2]] == pytest.approx(np.array([[1, 0], [2 / 3, 1 / 3], [0, 0]]))


def test_pooled_is_the_sum():
    east = GoalModel.from_trajectories([walk([1, 2, 3], [EAST, EAST])], 5, 2, [3])
    west = GoalModel.from_trajectories([walk([1, 0], [WEST])], 5, 2, [0])
    both = GoalModel.pooled([east, west])
    assert both.goals == ()
    assert both.theta[:3].tolist() == [[0, 0], [0.5, 0.5], [1, 0]]
    assert np.isfinite(both.steps).tolist() == [False, True, True, False, False]
    smooth = [replace(model, advised_alpha0=0.5) for model in (east, west)]
    assert GoalModel.pooled(smooth).theta[1].tolist() == [0.5, 0.5]
    assert GoalModel.pooled(smooth).theta[2].tolist() == [0.75, 0.25]
    with pytest.raises(InputError, match=r"goal_models must share advised_alpha0, got \[0.0, 0.5\]"):
        GoalModel.pooled([smooth[0], west])


def test_stitched_leads_on_over_others_ways_and_no_farther():
    # Experts went 1 → 2 → 3 and 1 → 0; place 4 nobody knows.
    east = GoalModel.from_trajectories([walk([1, 2, 3], [EAST, EAST])], 5, 2, [3])
    west = GoalModel.from_trajectories([walk([1, 0], [WEST])], 5, 2, [0])
    to_east, to_west = extend_goal_models([east, west], LINE)
    assert to_east.theta.tolist() == [[1, 0], [1, 0], [1, 0], [0, 0], [0, 0]]
    assert to_east.steps.tolist() == [3, 2, 1, np.inf, np.inf]
    assert to_west.theta.tolist() == [[0, 0], [0, 1], [0, 1], [0, 1], [0, 0]]
    assert to_west.steps.tolist() == [np.inf, 1, 2, 3, np.inf]
    # What they were made from is as it was.
    assert west.theta.tolist() == [[0, 0], [0, 1], [0, 0], [0, 0], [0, 0]]


@pytest.mark.parametrize(
    ("states", "actions", "words"),
    [
        ([0, 1], [0, 0], "one state more than actions"),
        ([0, 9], [0], r"states must lie in \[0, 5\)"),
        ([0, 1], [2], r"actions must lie in \[0, 2\)"),
    ],
)
def test_each_broken_rule_is_one_clear_line(states, actions, words):
    with pytest.raises(InputError, match=words):
        GoalModel.from_trajectories([walk(states, actions)], 5, 2)
