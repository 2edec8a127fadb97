"""What holds of every baseline in the registry."""

import inspect
import pkgutil
from importlib import import_module

import numpy as np
import pytest

import lifelore.interaction.baselines as room
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.baselines import BASELINES, Baseline, BayesOKR
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


TWO = PolicyLibrary.from_means([[1.0, 0.0], [0.0, 1.0]], 0.1)
GIVEN = {
    "gp-ucb": {"kernel": np.eye(2), "noise": 1.0},
    "lin-ucb": {"features": np.eye(2)},
    "bpr-plus": {"library": TWO},
}
DEVIATIONS = {"prior_means": [0, 0], "prior_deviations": [1, 1]}


@pytest.mark.parametrize(
    ("name", "settings", "said"),
    [
        ("bpr-plus", {"n_policies": 3}, "n_policies must be the library's 2, got 3"),
        ("bpr-plus", {"floor": 0.6}, r"floor must lie in \[0, 1/2\], got 0.6"),
        ("bpr-plus", {"threshold": 1.1}, r"threshold in \[0, 1\], got 10 and 1.1"),
        ("exp3", {}, "give either gamma or horizon"),
        ("exp3", {"gamma": 0.1, "horizon": 5}, "give either gamma or horizon"),
        ("exp3", {"gamma": np.nan}, "must"),
        ("exp3", {"horizon": 0}, "must"),
        ("exp3", {"horizon": np.nan}, "horizon must be at least 1"),
        ("gp-ucb", {"kernel": np.eye(3)}, "kernel must be 2 × 2"),
        ("gp-ucb", {"kernel": [[1, 2], [0, 1]]}, "kernel must be symmetric"),
        ("gp-ucb", {"kernel": [[1, 2], [2, 1]]}, "kernel must be positive semidefinite"),
        ("gp-ucb", {"noise": 0}, "noise must be finite and positive"),
        ("gp-ucb", {"beta": -1}, "beta must be finite and at least 0"),
        ("gp-ucb", {"delta": 1}, "delta must lie between 0 and 1"),
        ("interval-estimation", {"alpha": np.nan}, "alpha must lie between 0 and 1"),
        ("interval-estimation", {"quantile": "cauchy"}, "quantile must be 'student' or 'normal'"),
        ("interval-estimation", {"prior_means": [0, 0]}, "must be given both or neither"),
        ("interval-estimation", {**DEVIATIONS, "prior_pulls": 1}, "prior_pulls must be at least 2"),
        (
            "interval-estimation",
            {**DEVIATIONS, "prior_deviations": [1, -1]},
            "prior_deviations must be at least 0",
        ),
        ("lin-ucb", {"features": [[1.0]]}, r"features must be \(2, n_features\), finite, got shape \(1, 1\)"),
        ("lin-ucb", {"features": [[1.0], [np.inf]]}, "features must be"),
        ("lin-ucb", {"noise": 0.0}, "noise must be finite and positive, got 0.0"),
        ("lin-ucb", {"ridge": -1.0}, "ridge must be finite and positive"),
        ("lin-ucb", {"alpha": np.nan}, "alpha must be finite and at least 0"),
        ("sliding-window-ucb", {"window": 0}, "window must be at least 1, got 0"),
        ("sliding-window-ucb", {"window": np.nan}, "window must be at least 1, got nan"),
        ("thompson", {"noise": 0}, "must be"),
        ("thompson", {"prior_deviations": [1, 0]}, "must be"),
        ("try-all", {"rounds": np.nan}, "rounds must be at least 1, got nan"),
        ("try-all", {"rounds": 0}, "rounds must be at least 1, got 0"),
        ("ucb1", {"exploration": np.nan}, "exploration must be finite and at least 0"),
        ("ucb1", {"scale": (1, 1)}, "scale must be"),
        ("ucb1", {"prior_means": [1, 2, 3]}, "prior_means must be one number or 2 of them"),
        ("ucb1", {"prior_means": [1, 2], "prior_pulls": 0}, "prior_pulls must be finite and above 0"),
    ],
)
def test_bad_settings(name, settings, said):
    with pytest.raises(InputError, match=said):
        BASELINES[name](**{"n_policies": 2, **GIVEN.get(name, {}), **settings})


def test_bad_settings_of_bayes_okr():
    for settings, said in (
        ({"weight": 1.1}, r"weight must lie in \[0, 1\] and window be at least 1, got 1.1 and 1"),
        ({"floor": 0.6}, r"floor must lie in \[0, 1/2\], got 0.6"),
        ({"prior": [0.5, 0.5, 0.0]}, r"prior must be \(2,\), got \(3,\)"),
    ):
        with pytest.raises(InputError, match=said):
            BayesOKR(TWO, **settings)
