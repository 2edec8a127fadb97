"""Conformance of every registered environment: Gymnasium's checker, pictures, refusals, limits and docstrings."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from lifelore.core.errors import InputError
from lifelore.domains import ENVIRONMENTS

EVERY = pytest.mark.parametrize("name", sorted(ENVIRONMENTS))
DRAWN = [f"lifelore/{name}-v0" for name in ("AdviceMaze", "Building", "Lattice", "NoiseMaze")]
"""Environments that draw pictures: grid worlds."""
ENDS_EARLIER = {"lifelore/Telephone-v0"}
"""Environments whose episodes end by themselves before the limit, whatever is done."""


def test_every_environment_is_registered():
    assert {name for name in gymnasium.registry if name.startswith("lifelore/")} == set(ENVIRONMENTS)


@EVERY
def test_gymnasium_finds_nothing_to_say(name):
    if name in DRAWN:
        check_env(gymnasium.make(name, render_mode="rgb_array").unwrapped)
    check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


def test_the_interface_of_the_ball_game_is_an_environment_too():
    check_env(gymnasium.make("lifelore/BallGame-v0", role="interface").unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", DRAWN)
def test_pictures_follow_what_happens(name):
    env = gymnasium.make(name, render_mode="rgb_array").unwrapped
    env.reset(seed=3)
    first = env.render()
    assert first.dtype == np.uint8
    assert first.shape[2] == 3
    seen = {first.tobytes()}
    for action in range(env.action_space.n):
        env.reset(seed=3)
        env.step(action)
        seen.add(env.render().tobytes())
    assert len(seen) > 1
    assert gymnasium.make(name).unwrapped.render() is None


@EVERY
def test_steps_out_of_order_or_out_of_range(name):
    env = gymnasium.make(name).unwrapped
    with pytest.raises(InputError, match=r"reset\(\) must be called"):
        env.step(0)
    env.reset(seed=0)
    for wrong in (env.action_space.n, -1):
        with pytest.raises(InputError, match="action must lie in"):
            env.step(wrong)
    if name in DRAWN:
        with pytest.raises(InputError, match="render_mode must be None or one of: rgb_array; got 'human'"):
            type(env)(render_mode="human")


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
