"""Claim C3.1: useful actions by hand and against a naive twin; the figure shows the shares of the result."""

from collections import deque

import numpy as np
import pytest
from scipy import ndimage

from lifelore.domains.grids.grid_world import GridWorld
from reproduction.chapter3.c3_01_useful_actions.run import prior_of, uniform_maze
from reproduction.engine.estimates import quantile_estimate
from reproduction.engine.registry import claim_of

FULL = dict(claim_of("C3.1").sizes["full"])


def corridor():
    """Three cells in a row: states 0, 1, 2 from west to east."""
    return GridWorld.from_free("corridor", np.array([[True, True, True]]))


def test_corridor_by_hand():
    # Goal 2, twice: east is best in 0 and 1. Goal 0, once: west is best in 1 and 2. Actions N, S, E, W. At a goal
    # every action ties, and none is counted.
    prior = prior_of(corridor(), np.array([2, 0, 2]))
    assert prior.counts([0, 1, 2]).tolist() == [[0, 0, 2, 0], [0, 0, 2, 1], [0, 0, 0, 1]]


def steps_to(world, goal):
    """Naive twin of the exact solution: breadth-first from the goal."""
    steps = {goal: 0}
    queue = deque([goal])
    while queue:
        s = queue.popleft()
        for s2 in world.neighbour[s]:
            if s2 >= 0 and int(s2) not in steps:
                steps[int(s2)] = steps[s] + 1
                queue.append(int(s2))
    return steps


def test_useful_is_one_step_nearer_some_goal():
    random = np.random.default_rng(5)
    for _ in range(5):
        world = uniform_maze(random, 7, 6, 0.95)
        goals = random.integers(world.n_states, size=12)
        expected = np.zeros((world.n_states, 4))
        for goal in goals:
            steps = steps_to(world, int(goal))
            for s, a in np.ndindex(expected.shape):
                s2 = int(world.neighbour[s, a])
                expected[s, a] += s != goal and s2 >= 0 and steps[s2] == steps[s] - 1
        assert (prior_of(world, goals).counts(np.arange(world.n_states)) == expected).all()


def test_uniform_mazes_are_connected_with_the_obstacles_asked_for_and_differ():
    random = np.random.default_rng(0)
    free = set()
    for _ in range(20):
        world = uniform_maze(random, 7, 6, 0.95)
        picture = world.state_of >= 0
        assert picture.sum() == 19
        assert ndimage.label(picture)[1] == 1
        assert not picture[[0, -1]].any()
        assert not picture[:, [0, -1]].any()
        free.add(picture.tobytes())
    assert len(free) == 20


def test_measures_by_hand():
    mazes = [{"actions": 76, "useful": u, "passable": p} for u, p in ((38, 40), (42, 42), (57, 57), (60, 60))]
    settings = {**FULL, "generators": ["uniform"]}
    found, _ = claim_of("C3.1").measured(settings, [{"generator": "uniform", "mazes": mazes}])
    assert found["rank_of_42_of_76"].value == 1.5 / 4  # one below, half of the one that is equal
    assert found["rank_of_48_of_76"].value == 2 / 4
    assert found["passable_found_useful"].value == pytest.approx((38 / 40 + 3) / 4)


def test_quantile_interval_by_hand():
    # 100 values 1 … 100, median 50.5; Binomial(100, 1/2) has its 2.5 % and 97.5 % points at 40 and 60.
    found = quantile_estimate(np.arange(100.0, 0.0, -1.0), 0.5)
    assert (found.value, found.ci95, found.n) == (50.5, (40.0, 61.0), 100)
