"""Conformance of every registered environment: Gymnasium's checker, the limit of an episode, and its docstring."""

import gymnasium
import pytest
from gymnasium.utils.env_checker import check_env

from lifelore.domains import ENVIRONMENTS

EVERY = pytest.mark.parametrize("name", sorted(ENVIRONMENTS))
ENDS_EARLIER = {"lifelore/Telephone-v0"}
"""Environments whose episodes end by themselves before the limit, whatever is done."""


def test_every_environment_is_registered():
    assert {name for name in gymnasium.registry if name.startswith("lifelore/")} == set(ENVIRONMENTS)


@EVERY
def test_gymnasium_finds_nothing_to_say(name):
    check_env(gymnasium.make(name, render_mode="rgb_array").unwrapped)
    check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


def test_the_interface_of_the_ball_game_is_an_environment_too():
    check_env(gymnasium.make("lifelore/BallGame-v0", role="interface").unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", sorted(set(ENVIRONMENTS) - ENDS_EARLIER))
def test_an_episode_is_cut_at_its_limit(name):
    env = gymnasium.make(name, disable_env_checker=True)
    env.reset(seed=0)
    outcomes = [env.step(0)[2:4] for _ in range(ENVIRONMENTS[name][1])]
    assert outcomes[-1] == (False, True)
    assert not any(truncated for _, truncated in outcomes[:-1])


@EVERY
def test_docstrings_have_gymnasiums_headings(name):
    headings = ["Action Space", "Observation Space", "Rewards", "Starting State", "Episode End", "Arguments"]
    documented = type(gymnasium.make(name).unwrapped).__doc__
    places = [documented.index(f"## {heading}") for heading in headings]
    assert places == sorted(places)
