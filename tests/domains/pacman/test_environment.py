"""Conformance of the Pacman environment: Gymnasium, tables and kernel give one rollout, bit for bit."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils import seeding

from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, TERMINAL
from lifelore.domains.pacman.environment import PacmanEnvironment
from lifelore.domains.pacman.pacman import STRATEGIES, step
from lifelore.domains.pacman.picture import GHOST_COLOUR, PACMAN_COLOUR, draw_pacman

EVERY = pytest.mark.parametrize("strategy", STRATEGIES)


def made(**changes):
    return gymnasium.make("lifelore.domains:lifelore/Pacman-v0", **({"rows": 5, "columns": 5} | changes)).unwrapped


@pytest.mark.slow
@EVERY
def test_environment_tables_and_kernel_agree_bit_for_bit(strategy):
    env = made(strategy=strategy, seed=2)
    task, tables = env.task, env.task.tables()
    uniforms, _ = seeding.np_random(11)
    actions = np.random.default_rng(5)
    seen = {"terminal": 0, "collision": 0, "food": 0}
    observation, info = env.reset(seed=11)
    assert info["state"] == tables.starts[int(uniforms.random() * len(tables.starts))]
    for _ in range(3000):
        state = info["state"]
        assert observation == task.observation_of[state]
        action, u = int(actions.integers(4)), uniforms.random()
        outcome = int(np.searchsorted(tables.outcome_cum, u, side="right"))
        index = (state, action, outcome)
        row = (int(tables.next_state[index]), float(tables.reward[index]), int(tables.event[index]))
        assert step(task.params, state, action, u) == row
        observation, reward, terminated, truncated, info = env.step(action)
        event = TERMINAL * terminated | COLLISION * info["collision"]
        assert (info["state"], reward, event) == row
        assert (type(observation), type(reward), truncated) == (int, float, False)
        seen["terminal"] += terminated
        seen["collision"] += info["collision"]
        seen["food"] += reward > 0
        if terminated:
            observation, info = env.reset()
            uniforms.random()
    assert min(seen.values()) > 10


def test_strategy_and_foods_are_drawn_from_the_seed():
    drawn = [made(seed=seed).task for seed in range(12)]
    assert {task.strategy for task in drawn} == set(STRATEGIES)
    assert made(seed=3).task.foods == drawn[3].foods != drawn[4].foods
    assert made(foods=[0, 1, 2, 3]).task.foods == (0, 1, 2, 3)


def test_a_ghost_out_of_sight_is_pale():
    env = made(strategy="clockwise", foods=(0, 4, 14, 18), render_mode="rgb_array")
    task, here = env.task, env.task.starts
    own, ghost, _ = task.parts(here)
    shown = task.maze.sees[own, ghost]
    for state, seen in zip(here[[shown.argmax(), shown.argmin()]], (True, False), strict=True):
        env.reset(options={"state": int(state)})
        picture = env.render()
        assert (picture == draw_pacman(task, int(state))).all()
        assert (picture == PACMAN_COLOUR).all(axis=2).any()
        assert (picture == GHOST_COLOUR).all(axis=2).any() == seen
    assert made().render() is None


def test_what_is_refused():
    env = made()
    with pytest.raises(InputError, match="reset"):
        env.step(0)
    with pytest.raises(InputError, match="reset"):
        made(render_mode="rgb_array").render()
    env.reset()
    with pytest.raises(InputError, match="action must lie in"):
        env.step(4)
    for state in (0, env.task.n_states, True, "x"):
        with pytest.raises(InputError, match=r"options\['state'\] must be a state"):
            env.reset(options={"state": state})
    with pytest.raises(InputError, match="render_mode"):
        PacmanEnvironment(render_mode="human")
