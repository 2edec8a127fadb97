"""Which actions teach the prior, by hand: by sign where a value is positive, else by the best returns."""

import numpy as np

from lifelore.agent.external_world.useful_actions import EpisodeReturns, useful_actions

HALL, STAIRS = ("hall", 0), ("stairs", 1)


def returns_of(*episodes, n_actions=3):
    returns = EpisodeReturns(n_actions)
    for steps, earned, ended in episodes:
        returns.add([(*place, action) for place, action in steps], earned, ended)
    return returns


def test_a_positive_value_decides_by_sign_as_it_always_did():
    q = np.array([[2.0, 1.0, 2.0], [-1.0, 0.0, -1.0]])
    returns = returns_of(([(STAIRS, 1)], -1.0, True), ([(STAIRS, 0)], -9.0, True))
    assert useful_actions(q, [HALL, STAIRS], returns).tolist() == [[True, False, True], [False] * 3]


def test_without_a_positive_value_the_best_taken_in_the_best_tenth_counts():
    """Twenty episodes: the two best return -2. Action 2 of the hall was never taken, so its value 0 is no news."""
    q = np.array([[-3.0, -1.5, 0.0], [-4.0, -4.0, -1.0]])
    worse = [([(HALL, 0), (STAIRS, 0)], -9.0, True)] * 18
    best = [([(HALL, 0), (HALL, 1)], -2.0, True), ([(HALL, 1), (STAIRS, 1)], -2.0, True)]
    useful = useful_actions(q, [HALL, STAIRS], returns_of(*worse, *best))
    assert useful.tolist() == [[False, True, False], [False, True, False]]


def test_episodes_that_did_not_end_teach_nothing():
    q = np.array([[-3.0, -1.0, 0.0]])
    idle = returns_of(*[([(HALL, 0)], -9.0, True)] * 9, ([(HALL, 1)], -2.0, False))
    assert not useful_actions(q, [HALL], idle).any()


def test_equal_returns_teach_nothing():
    assert not useful_actions(-np.ones((1, 3)), [HALL], returns_of(*[([(HALL, 0)], -1.0, True)] * 9)).any()
    assert useful_actions(np.empty((0, 3)), [], EpisodeReturns(3)).shape == (0, 3)
