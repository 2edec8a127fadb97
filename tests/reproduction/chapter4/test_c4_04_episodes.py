"""Episodes of a fixed policy against a plain loop on the same random numbers."""

import numpy as np
import pytest

from lifelore.core.compiled.random_state import random_state
from lifelore.core.learning.q_learning import cumulative
from lifelore.core.mdp import TERMINAL
from lifelore.core.streams import stream
from reproduction.chapter4.c4_04_pacman.episodes import episode_returns


@pytest.mark.parametrize("n_outcomes", [1, 3])
def test_returns_equal_a_plain_loop(draw_world, big_random, n_outcomes):
    tables = draw_world(n_outcomes, n_states=6, n_outcomes=n_outcomes)
    row_of = np.array([0, 1, 2, 3, 0, 1], np.int32)
    policy = cumulative(np.random.default_rng(0).dirichlet(np.ones(3), 4))
    returns = episode_returns(tables, row_of, policy, 7, 200, world=stream(1, "w"), own=stream(1, "o"))
    world, own = big_random(random_state(stream(1, "w"))), big_random(random_state(stream(1, "o")))
    for found in returns:
        state, expected = int(tables.starts[int(world.uniform() * len(tables.starts))]), 0.0
        for _ in range(7):
            action = int(np.searchsorted(policy[row_of[state]], own.uniform(), side="right"))
            outcome = 0
            if n_outcomes > 1:
                outcome = int(np.searchsorted(tables.outcome_cum, world.uniform(), side="right"))
            expected += tables.reward[state, action, outcome]
            if tables.event[state, action, outcome] & TERMINAL:
                break
            state = int(tables.next_state[state, action, outcome])
        assert found == expected
