"""Holding only the layers met changes nothing, to the bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.core.learning.layered_learning import LayeredLearning
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import uniform_rows
from lifelore.core.streams import stream

SIZE, N_LAYERS = 4, 6


def rows_of(tables):
    def rows(layer):
        here = slice(layer * SIZE, (layer + 1) * SIZE)
        return tables._replace(
            next_state=tables.next_state[here], reward=tables.reward[here], event=tables.event[here]
        )

    return rows


def streams(seed):
    return {"world": stream(seed, "world"), "own": stream(seed, "own")}


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([1, 3]), st.sampled_from([3, 7, 50]), st.booleans())
def test_same_as_on_the_whole_tables(draw_layers, seed, n_outcomes, max_steps, prior):
    tables = draw_layers(seed, n_layers=N_LAYERS, size=SIZE, n_outcomes=n_outcomes)
    settings_ = QLearning(episodes=12, max_steps=max_steps, epsilon=0.6, epsilon_decay=0.9)
    given_rows, probs = None, {}
    if prior:
        random = np.random.default_rng(seed)
        explore = random.dirichlet(np.ones(tables.n_actions), tables.n_states)
        ties = random.uniform(0.5, 2.0, explore.shape)
        given_rows = uniform_rows(tables, explore, ties)
        probs = {
            "explore_of": lambda layer: explore[layer * SIZE : (layer + 1) * SIZE],
            "ties_of": lambda layer: ties[layer * SIZE : (layer + 1) * SIZE],
        }
    whole, curve = settings_.learn(tables, 0.9, **streams(seed), rows=given_rows)
    part = LayeredLearning(rows_of(tables), N_LAYERS, SIZE, **streams(seed), **probs)
    for met, known in zip(part.learn(settings_, 0.9), curve, strict=True):
        assert np.array_equal(met, known)
    assert np.array_equal(np.concatenate([part.q(layer) for layer in range(N_LAYERS)]), whole.q)
    assert np.array_equal(np.concatenate([part.visits(layer) for layer in range(N_LAYERS)]), whole.visits)
    for met, known in zip(part.random_states, (whole.world_random, whole.own_random), strict=True):
        assert np.array_equal(met, known)
    visited = set(np.flatnonzero(whole.visits.any(axis=1)) // SIZE)
    assert visited <= set(part.layers)
    assert len(part.layers) == len(set(part.layers))


def test_layers_out_of_reach_are_never_laid_out(draw_layers):
    tables = draw_layers(0, n_layers=N_LAYERS, size=SIZE)
    tables = tables._replace(starts=np.array([4 * SIZE], np.int32))
    part = LayeredLearning(rows_of(tables), N_LAYERS, SIZE, **streams(0))
    assert part.layers == [4]
    part.learn(QLearning(episodes=30), 0.9)
    assert set(part.layers) <= {4, 5}
    assert not part.q(2).any()
    assert part.visits(2).dtype == np.int64


def test_misuse_is_told(draw_layers):
    tables = draw_layers(0, n_layers=N_LAYERS, size=SIZE)
    part = LayeredLearning(rows_of(tables), N_LAYERS, SIZE, **streams(0))
    part.learn(QLearning(episodes=2), 0.9)
    with pytest.raises(InputError, match="runs once"):
        part.learn(QLearning(episodes=2), 0.9)
    with pytest.raises(InputError, match=r"layer must lie in \[0, 6\), got 6"):
        part.q(6)
    with pytest.raises(InputError, match="stay below"):
        LayeredLearning(rows_of(tables), 2**20, 2**10, **streams(0))
    bad = {"explore_of": lambda layer: np.full((SIZE, tables.n_actions), 0.9)}
    with pytest.raises(InputError, match="explore must hold probabilities"):
        LayeredLearning(rows_of(tables), N_LAYERS, SIZE, **streams(0), **bad)
