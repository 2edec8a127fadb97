"""What holds of every baseline in the registry."""

import inspect
import pkgutil
from importlib import import_module

import numpy as np
import pytest

import lifelore.interaction.baselines as room
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.baselines import BASELINES, Baseline
from lifelore.interaction.library.policy_library import PolicyLibrary

SETTINGS = {"exp3": {"horizon": 50}}
NAMES = sorted(BASELINES)


def make(name, library, **common):
    return BASELINES[name].from_library(library, **SETTINGS.get(name, {}), **common)


def played(player, means, episodes, noise):
    """Policies chosen, payoffs drawn from `noise` (episodes, rows, policies)."""
    chosen = []
    for extra in noise[:episodes]:
        policy = np.atleast_1d(player.select())
        paid = means[np.arange(len(policy)) % len(means), policy] + extra[np.arange(len(policy)), policy]
        player.update(int(policy[0]) if player.n_tasks is None else policy, paid if player.n_tasks else paid[0])
        chosen.append(policy)
    return np.array(chosen)


def test_the_registry_is_complete():
    found = set()
    for module in pkgutil.iter_modules(room.__path__, room.__name__ + "."):
        for _, kind in inspect.getmembers(import_module(module.name), inspect.isclass):
            if issubclass(kind, Baseline) and not inspect.isabstract(kind):
                found.add(kind)
    assert found == set(BASELINES.values())
    assert all(kind.name == name for name, kind in BASELINES.items())


@pytest.mark.parametrize("name", NAMES)
def test_one_task_is_a_batch_of_one(name, library):
    noise = np.random.default_rng(1).normal(0, 0.1, (60, 1, 4))
    one = played(make(name, library, seed=3), library.performance.mean, 60, noise)
    batch = played(make(name, library, seed=3, n_tasks=1), library.performance.mean, 60, noise)
    assert np.array_equal(one, batch)
    assert isinstance(make(name, library).select(), int)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_best_policy_of_each_task_is_played_in_the_end(name, library):
    noise = np.random.default_rng(2).normal(0, 0.1, (1500, 6, 4))
    settings = {"gamma": 0.1} if name == "exp3" else {}
    player = BASELINES[name].from_library(library, n_tasks=6, seed=4, **settings)
    chosen = played(player, library.performance.mean, 1500, noise)
    best = library.performance.mean.argmax(axis=1)[np.arange(6) % 2]
    # A policy drawn at random is the best one in a quarter of plays; exp3 keeps a tenth of such play.
    assert (chosen[-300:] == best).mean() > 0.8


@pytest.mark.parametrize("name", NAMES)
def test_bad_input_is_refused_and_nothing_is_learnt_from_it(name, library):
    player, twin = make(name, library, n_tasks=2, seed=1), make(name, library, n_tasks=2, seed=1)
    for policies, rewards, error in (
        ([0, 4], [0.0, 0.0], NotFoundError),
        ([0, -1], [0.0, 0.0], NotFoundError),
        ([0, 1], [0.0, np.nan], InputError),
        ([0, 1], [0.0, np.inf], InputError),
        ([0, 1], [0.0, -1e200], InputError),
        ([0, 1], [0.0], InputError),
        ([0.0, 1.0], [0.0, 0.0], InputError),
        ([0, 1, 2], [0.0, 0.0, 0.0], InputError),
    ):
        with pytest.raises(error):
            player.update(policies, rewards)
    assert player.episode == 0
    assert np.array_equal(player.select(), twin.select())
    assert np.array_equal(player._scores(), twin._scores()) if name != "thompson" else True


@pytest.mark.parametrize("name", NAMES)
def test_no_policies_or_tasks_is_refused(name, library):
    extra = {
        "gp-ucb": {"kernel": np.eye(1), "noise": 1.0},
        "lin-ucb": {"features": [[1.0]]},
        "bpr-plus": {"library": PolicyLibrary.from_means([[1.0]], 1.0)},
    }.get(name, {})
    extra |= SETTINGS.get(name, {})
    with pytest.raises(InputError, match="n_policies must be at least 1, got 0"):
        BASELINES[name](0, **extra)
    with pytest.raises(InputError, match="n_tasks must be at least 1, got 0"):
        BASELINES[name](1, n_tasks=0, **extra)
    only = BASELINES[name](1, **extra)
    only.update(only.select(), 1.0)
    assert only.select() == 0
