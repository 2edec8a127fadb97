"""The explorers of Table 3.1, by hand on small worlds."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains import GridWorld, noise_maze
from lifelore.domains.advice.explorers import EXPLORERS, explorer_probs

NORTH, SOUTH, EAST, WEST = range(4)
CROSS = GridWorld.from_free("cross", np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], bool))
"""States: 0 north arm, 1 west arm, 2 middle, 3 east arm, 4 south arm."""


@pytest.mark.parametrize("explorer", EXPLORERS)
def test_rows_are_probabilities_and_only_the_random_and_the_bug_bump(explorer):
    world = noise_maze(np.random.default_rng(3), 11, 0.4)
    probs = explorer_probs(world, explorer, 5 if explorer == "bug" else None)
    assert probs.shape == (world.n_states, 5, 4)
    assert probs.sum(axis=2) == pytest.approx(np.ones((world.n_states, 5)))
    bumps = (probs * (world.neighbour < 0)[:, None]).sum()
    assert (bumps > 0) == (explorer in ("random", "bug"))


@pytest.mark.parametrize(("heading", "order"), [(NORTH, "WNES"), (SOUTH, "ESWN"), (EAST, "NESW"), (WEST, "SWNE")])
def test_left_straight_right_back(heading, order):
    # With all four ways open the first of the order is taken; close it and the next one is, and so on.
    names = "NSEW"
    steps = dict(zip(names, [(0, 1), (2, 1), (1, 2), (1, 0)], strict=True))
    free = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], bool)
    for direction in order:
        world = GridWorld.from_free("cross", free)
        middle = world.state_of[1, 1]
        assert names[explorer_probs(world, "left")[middle, heading + 1].argmax()] == direction
        free[steps[direction]] = False
        if free.sum() < 2:
            break


def test_the_bug_takes_the_second_best_way_where_the_best_is_blocked_and_else_pushes_at_the_wall():
    free = np.ones((5, 5), bool)
    free[2, 1] = False
    world = GridWorld.from_free("floor", free)
    bug = explorer_probs(world, "bug", int(world.state_of[0, 4]))[:, 0]
    assert bug[world.state_of[2, 0]].tolist() == [1, 0, 0, 0]
    free[1, 0] = False
    walled = GridWorld.from_free("floor", free)
    stuck = explorer_probs(walled, "bug", int(walled.state_of[0, 4]))[:, 0]
    assert stuck[walled.state_of[2, 0]].tolist() == [0, 0, 1, 0]


def test_each_broken_rule_is_one_clear_line():
    with pytest.raises(NotFoundError, match="explorer must be one of random, avoid, left, bug, got 'fly'"):
        explorer_probs(CROSS, "fly")
    for explorer, goal in (("bug", None), ("left", 2)):
        with pytest.raises(InputError, match="goal must be given for the bug and for no other"):
            explorer_probs(CROSS, explorer, goal)
