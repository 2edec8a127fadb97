"""The Pacman environment: what is drawn from its seed, what its picture shows, states to start in."""

import gymnasium
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.pacman.pacman import STRATEGIES
from lifelore.domains.pacman.picture import GHOST_COLOUR, PACMAN_COLOUR, draw_pacman


def made(**changes):
    return gymnasium.make("lifelore.domains:lifelore/Pacman-v0", **({"rows": 5, "columns": 5} | changes)).unwrapped


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


def test_a_state_that_is_none_is_refused():
    with pytest.raises(InputError, match="reset"):
        made(render_mode="rgb_array").render()
    env = made()
    for state in (0, env.task.n_states, True, "x"):
        with pytest.raises(InputError, match=r"options\['state'\] must be a state"):
            env.reset(options={"state": state})
