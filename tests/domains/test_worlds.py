"""Worlds by name."""

import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.worlds import WorldSettings, domain_names, make_world, world_from_settings


def test_the_defaults_of_each_domain():
    worlds = {name: make_world(name) for name in domain_names()}
    assert {name: world.discount for name, world in worlds.items()} == {
        "building": 0.99,
        "lattice": 0.95,
        "noise": 0.95,
        "advice": 0.95,
    }
    rewards = {name: (world.goal_reward, world.wall_reward) for name, world in worlds.items()}
    assert rewards.pop("advice") == (1000.0, 0.0)
    assert set(rewards.values()) == {(100.0, -10.0)}
    assert all(world.name == name for name, world in worlds.items())


@pytest.mark.parametrize("name", domain_names())
def test_rewards_discount_and_seed_are_options_everywhere(name):
    settings = WorldSettings(name, discount=0.5, goal_reward=1.0, wall_reward=-2.0, seed=4)
    world = world_from_settings(settings)
    assert (world.discount, world.goal_reward, world.wall_reward) == (0.5, 1.0, -2.0)
    assert world.fingerprint == world_from_settings(settings).fingerprint


def test_an_unknown_domain_lists_the_known():
    with pytest.raises(NotFoundError, match="domain must be one of building, lattice, noise, advice, got 'house'"):
        make_world("house")


@pytest.mark.parametrize(
    ("name", "setting"),
    [
        ("lattice", {"map": "m.yaml"}),
        ("noise", {"cell": 0.5}),
        ("building", {"density": 0.5}),
        ("building", {"size": 9}),
        ("noise", {"loops": 0.1}),
    ],
)
def test_a_setting_without_use_is_refused(name, setting):
    with pytest.raises(InputError, match=f"{next(iter(setting))} does not apply to domain '{name}'"):
        make_world(name, **setting)
