"""The Pacman environment: what is drawn from its seed, what its picture shows, states to start in."""

import gymnasium
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.pacman.pacman import STRATEGIES


def made(**changes):
    return gymnasium.make("lifelore.domains:lifelore/Pacman-v0", **({"rows": 5, "columns": 5} | changes)).unwrapped


def test_strategy_and_foods_are_drawn_from_the_seed():
    drawn = [made(seed=seed).task for seed in range(12)]
    assert {task.strategy for task in drawn} == set(STRATEGIES)
    assert made(seed=3).task.foods == drawn[3].foods != drawn[4].foods
    assert made(foods=[0, 1, 2, 3]).task.foods == (0, 1, 2, 3)


def test_a_state_that_is_none_is_refused():
    env = made()
    for state in (0, env.task.n_states, True, "x"):
        with pytest.raises(InputError, match=r"options\['state'\] must be a state"):
            env.reset(options={"state": state})
