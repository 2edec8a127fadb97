"""The value of the known paths beside an evaluation of every state, after every few steps of learning."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core import COLLISION, TERMINAL, Tables, stream
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.known_value import KnownValue
from lifelore.core.learning.known_world import WorldModel, unknown_world
from lifelore.core.learning.model_learning import ExplorationStrategy, StateInfo, explore, new_model_learner

seeds = st.integers(0, 10**6)


def maze(seed: int, n=40, n_actions=4, goals=1) -> Tables:
    """Places joined at random; refused moves cost, the moves into the goals end the episode with 100."""
    random = np.random.default_rng(seed)
    here = np.arange(n)[:, None]
    refused = random.random((n, n_actions)) < 0.4
    next_state = np.where(refused, here, random.integers(0, n, (n, n_actions)))
    next_state[-1, 0] = 0  # some move leads into a goal
    refused = next_state == here
    wins = ~refused & (next_state < goals)
    reward = np.where(refused, -10.0, np.where(wins, 100.0, 0.0))
    event = np.where(refused, COLLISION, np.where(wins, TERMINAL, 0))
    tables = (next_state.astype(np.int32), reward, event.astype(np.uint8))
    return Tables(*(table[:, :, None] for table in tables), np.ones(1), np.arange(goals, n, dtype=np.int32))


def follow(tables, model, strategy=ExplorationStrategy(), seed=0, chunk=7, chunks=150):  # noqa: B008 — a frozen tuple
    """`KnownValue.update` and `exact` after every `chunk` steps; the follower too."""
    n = tables.n_states
    explorer = new_model_learner(n, tables.n_actions, stream(seed, "world"), stream(seed, "own"))
    seen = StateInfo(np.zeros(n, np.int64), np.zeros(n, np.int32), np.zeros((1, tables.n_actions)))
    known, curve, values = KnownValue(tables, model, explorer, 0.95), new_curve(chunks * chunk), []
    for _ in range(chunks):
        explore(tables, model, seen, strategy, explorer, curve, 60, 0.95, chunk)
        values.append((known.update(), known.exact()))
    return known, np.array(values)


@pytest.mark.slow
@settings(max_examples=25)
@given(
    seeds,
    st.sampled_from(
        [
            ExplorationStrategy(),
            ExplorationStrategy(exhaustive=True),
            ExplorationStrategy(senses=True),
            ExplorationStrategy(planned=False),
        ]
    ),
    st.integers(1, 3),
    st.sampled_from([0.0, 0.5, 1.0]),
)
def test_kept_up_to_date_equals_evaluating_every_state(seed, strategy, goals, remembered):
    """With nothing, half or all of the world remembered; with several goals a way may end at an unmet one."""
    tables, model = maze(seed, goals=goals), unknown_world(40, 4)
    kept = np.random.default_rng(seed).random((40, 4)) < remembered
    model.target[kept] = tables.next_state[:, :, 0][kept]
    known, values = follow(tables, model, strategy, seed)
    assert goals > 1 or known._by_distance is not None  # the quick way is among what is tested
    assert values[:, 0] == pytest.approx(values[:, 1], rel=1e-12, abs=1e-300)


@pytest.mark.slow
@settings(max_examples=40)
@given(seeds)
def test_any_world_and_any_remembered_model(draw_world, seed):
    """Rewards on the way, bad ends, a model that is not true: then every state is evaluated."""
    tables = draw_world(seed, n_states=12)
    random = np.random.default_rng(seed)
    model = WorldModel(random.integers(-1, 12, (12, 3)).astype(np.int32), random.integers(0, 2, 12))
    _, values = follow(tables, model, seed=seed, chunk=3, chunks=60)
    assert values[:, 0] == pytest.approx(values[:, 1], rel=1e-12, abs=1e-300)
