"""Environments of grids, factories and Pacman: one definition, three ways to run it."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils import seeding

from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, TERMINAL, _enumerate_with
from lifelore.domains.factory.contexts import features
from lifelore.domains.grid_environment import GridEnvironment
from lifelore.domains.pacman.pacman import STRATEGIES, step

CASES = {
    "lifelore/AdviceMaze-v0": {"size": 12, "seed": 2},
    "lifelore/Building-v0": {"seed": 3, "cell": 0.8},
    "lifelore/Factory-v0": {"components": 2, "seed": 1},
    "lifelore/Lattice-v0": {"size": 11},
    "lifelore/ModifiedFactory-v0": {"components": 2, "seed": 3},
    "lifelore/NoiseMaze-v0": {"size": 13, "seed": 2},
}
"""Arguments that keep the plain enumeration short."""
EVERY = pytest.mark.parametrize("name", sorted(CASES))


def plain(name: str, **changes):
    return gymnasium.make(f"lifelore.domains:{name}", **(CASES[name] | changes)).unwrapped


def percepts(env):
    """The entry of ``info`` that tells what the agent perceives, and its value in each state."""
    if isinstance(env, GridEnvironment):
        return "percept", env.world.percepts.tolist()
    return "features", list(map(tuple, features(env.factory_task).tolist()))


@EVERY
def test_a_grid_or_a_factory_is_its_tables_bit_for_bit(name):
    env = plain(name)
    entry, percept_of = percepts(env)
    check_rollout(
        env, env.task.domain.step, lambda state, shown, info: shown == state and info[entry] == percept_of[state]
    )


@pytest.mark.slow
@pytest.mark.parametrize("strategy", STRATEGIES)
def test_pacman_is_its_tables_bit_for_bit(strategy):
    env: Any = gymnasium.make(
        "lifelore.domains:lifelore/Pacman-v0", rows=5, columns=5, seed=2, strategy=strategy
    ).unwrapped
    shown_in = env.task.observation_of.tolist()
    check_rollout(env, step, lambda state, shown, info: shown == shown_in[state] and info["state"] == state)


def check_rollout(env, step, shows):
    """2,000 steps of the environment, its tables and its step agree, and each observation `shows` the state."""
    task, tables = env.task, env.task.tables()
    ends = (tables.event & TERMINAL > 0).mean(axis=(1, 2))
    near_the_end = np.flatnonzero((ends > 0) & (ends < 1))
    uniforms, _ = seeding.np_random(11)
    actions = np.random.default_rng(5)
    seen = {"terminal": 0, "collision": 0}
    observation, info = env.reset(seed=11)
    state = tables.starts[int(uniforms.random() * len(tables.starts))]
    for _ in range(2000):
        assert shows(state, observation, info)
        action, u = int(actions.integers(env.action_space.n)), uniforms.random()
        outcome = int(np.searchsorted(tables.outcome_cum, u, side="right"))
        index = (state, action, outcome)
        state, *row = int(tables.next_state[index]), float(tables.reward[index]), int(tables.event[index])
        assert step(task.params, index[0], action, u) == (state, *row)
        observation, reward, terminated, truncated, info = env.step(action)
        assert [reward, TERMINAL * terminated | COLLISION * info["collision"]] == row
        assert (type(observation), type(reward), truncated) == (int, float, False)
        seen["terminal"] += terminated
        seen["collision"] += info["collision"]
        if terminated or actions.random() < 0.05:
            state = int(actions.choice(near_the_end))
            observation, info = env.reset(options={"state": state})
            uniforms.random()
    assert min(seen.values()) > 10


@EVERY
def test_the_compiled_table_equals_the_plain_enumeration(name):
    task = plain(name).task
    compiled = task.tables()
    for fast, slow in zip(compiled[:3], _enumerate_with(task.domain)(task.params, [0.5]), strict=True):
        assert fast.dtype == slow.dtype
        assert np.array_equal(fast, slow)


def test_a_start_that_is_no_state_is_refused():
    env = plain("lifelore/Lattice-v0")
    for wrong in (env.task.domain.n_states, -1, 1.5, "a", True):
        with pytest.raises(InputError, match=r"options\['state'\] must"):
            env.reset(options={"state": wrong})


def test_the_goal_may_be_a_state_or_a_cell():
    env = plain("lifelore/Lattice-v0", goal=7)
    cell = tuple(env.world.cells[7].tolist())
    assert env.task.goal == plain("lifelore/Lattice-v0", goal=cell).task.goal == 7
    for wrong in ((0, 0), (-1, 1), (99, 1)):
        with pytest.raises(InputError, match="goal must be a free cell"):
            plain("lifelore/Lattice-v0", goal=wrong)
    with pytest.raises(InputError, match="goal must be a state"):
        plain("lifelore/Lattice-v0", goal=10_000)
    assert len({plain("lifelore/Lattice-v0", seed=seed).task.goal for seed in range(6)}) > 1
