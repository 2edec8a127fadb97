"""Exact moments of returns against the plain recursion over all ways an episode can go."""

import numpy as np
import pytest

from lifelore.core.mdp import TERMINAL
from reproduction.chapter4.c4_04_pacman.pacman_library import return_moments


def naive_moments(tables, row_of, probs, steps):
    """E[G] and E[G²] by following every branch."""

    def onward(s, left):
        if left == 0:
            return 0.0, 0.0
        first = second = 0.0
        for a in range(tables.n_actions):
            for k, w in enumerate(np.diff(tables.outcome_cum, prepend=0.0)):
                r, later, later2 = tables.reward[s, a, k], 0.0, 0.0
                if not tables.event[s, a, k] & TERMINAL:
                    later, later2 = onward(tables.next_state[s, a, k], left - 1)
                p = probs[row_of[s], a] * w
                first += p * (r + later)
                second += p * (r * r + 2 * r * later + later2)
        return first, second

    return np.mean([onward(s, steps) for s in tables.starts], axis=0)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_moments_equal_the_recursion(draw_world, seed):
    tables = draw_world(seed, n_states=6, n_actions=2, n_outcomes=2)
    random = np.random.default_rng(seed)
    # Two states share a row: a hidden state.
    row_of = np.array([0, 1, 2, 3, 4, 0], np.int32)
    probs = random.dirichlet(np.ones(2), 5)
    probs[1] = [1.0, 0.0]
    first, second = naive_moments(tables, row_of, probs, 5)
    mean, deviation = return_moments(tables, row_of, probs, 5)
    assert mean == pytest.approx(first, abs=1e-12)
    assert deviation == pytest.approx(np.sqrt(second - first**2), abs=1e-9)


def test_a_start_named_twice_counts_twice(draw_world):
    tables = draw_world(3, n_states=4, n_actions=2)
    probs = np.full((4, 2), 0.5)
    row_of = np.arange(4, dtype=np.int32)

    def mean(*starts):
        return return_moments(tables._replace(starts=np.array(starts, np.int32)), row_of, probs, 9)[0]

    assert mean(0, 0, 1) == pytest.approx((2 * mean(0) + mean(1)) / 3)
