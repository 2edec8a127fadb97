"""BPR+: the naive twin of belief, floor and detection; switches, and returns that no type explains."""

from math import exp, pi, sqrt

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.baselines import BPRPlus
from lifelore.interaction.baselines.bpr_plus import floored
from lifelore.interaction.library.policy_library import PolicyLibrary

MEAN = [[1.0, 0.2, 0.4], [0.0, 0.8, 0.6]]


def naive_belief(mean, deviation, prior, floor, window, threshold, played):
    """The belief after `played` policies and returns, with every sum written out."""
    belief, fits = list(prior), []
    for policy, paid in played:
        likelihoods, fit = [], []
        for type_ in range(len(prior)):
            z = (paid - mean[type_][policy]) / deviation
            likelihoods.append(exp(-z * z / 2) / (deviation * sqrt(2 * pi)))
            fit.append(exp(-z * z / 2))
        joint = [b * f for b, f in zip(belief, likelihoods, strict=True)]
        raised = [max(value / sum(joint), floor) for value in joint]
        belief = [value / sum(raised) for value in raised]
        fits.append(fit)
        last = fits[-window:]
        if len(last) == window and max(sum(of_type) / window for of_type in zip(*last, strict=True)) < threshold:
            belief, fits = list(prior), []
    return belief


@pytest.mark.parametrize(("window", "threshold"), [(4, 0.6), (3, 0.9), (10, 0.4)])
def test_a_naive_bpr_plus_has_the_same_belief(window, threshold):
    random = np.random.default_rng(1)
    library = PolicyLibrary.from_means(MEAN, 0.3, prior=[0.7, 0.3])
    settings = {"floor": 0.02, "window": window, "threshold": threshold}
    player = BPRPlus.from_library(library, **settings)
    played, begun = [], 0
    for episode in range(80):
        policy = player.select()
        own = MEAN[episode // 20 % 2] if episode < 60 else [2.0, 2.0, 2.0]
        played.append((policy, own[policy] + float(random.normal(0, 0.3))))
        player.update(*played[-1])
        expected = naive_belief(MEAN, 0.3, [0.7, 0.3], played=played, **settings)
        assert player.belief.tolist() == pytest.approx(expected, rel=1e-9)
        begun += expected == [0.7, 0.3]
    # The last twenty returns fit no type.
    assert begun >= 1


def test_each_task_of_many_has_the_belief_that_it_has_alone():
    random = np.random.default_rng(2)
    library = PolicyLibrary.from_means(MEAN, 0.3)
    settings = {"window": 3, "threshold": 0.7}
    many = BPRPlus.from_library(library, n_tasks=4, **settings)
    alone = [BPRPlus.from_library(library, **settings) for _ in range(4)]
    for _ in range(40):
        policies, paid = random.integers(3, size=4), random.normal(0.5, 0.6, 4)
        many.update(policies, paid)
        for player, policy, value in zip(alone, policies, paid, strict=True):
            player.update(int(policy), float(value))
        assert many.belief == pytest.approx(np.array([player.belief for player in alone]))


def test_a_switch_is_followed_because_no_belief_falls_below_the_floor():
    library = PolicyLibrary.from_means(MEAN, 0.1)
    episodes = {}
    for floor in (0.0, 0.001):
        player = BPRPlus.from_library(library, floor=floor, window=0)
        for _ in range(200):
            player.update(0, 1.0)
        episodes[floor] = 0
        while player.select() == 0 and episodes[floor] < 50:
            player.update(0, 0.0)
            episodes[floor] += 1
    # A return of 0 after one of 1 is a likelihood ratio of e⁵⁰: one episode from 0.001, and 200 without a floor.
    assert episodes == {0.0: 50, 0.001: 1}


def test_returns_that_fit_no_type_set_the_belief_back_to_the_prior():
    library = PolicyLibrary.from_means(MEAN, 0.1, prior=[0.6, 0.4])
    player, never = BPRPlus.from_library(library, window=5), BPRPlus.from_library(library, window=0)
    for number in range(1, 6):
        for each in (player, never):
            each.update(0, 3.0)
        assert (player.belief.tolist() == pytest.approx([0.6, 0.4])) == (number == 5)
    assert never.belief[0] > 0.99


def test_a_known_type_is_seldom_lost():
    random = np.random.default_rng(3)
    player = BPRPlus.from_library(PolicyLibrary.from_means(MEAN, 0.3), n_tasks=500)
    lost = 0
    for _ in range(100):
        policies = player.select()
        player.update(policies, np.array(MEAN)[0, policies] + random.normal(0, 0.3, 500))
        lost += (player._seen == 0).sum()
    # A window's mean is 0.71 ± 0.09 for the right type: 0.4 is 3.5 deviations below, and windows overlap.
    assert lost < 0.002 * 500 * 100


def test_returns_of_categories_are_read_by_the_librarys_own_model():
    samples = np.array([[[0.0] * 9 + [1.0], [1.0] * 9 + [0.0]], [[1.0] * 9 + [0.0], [0.0] * 9 + [1.0]]])
    library = PolicyLibrary.from_samples(samples, model="categorical")
    player = BPRPlus.from_library(library, floor=0.0)
    player.update(0, 1.0)
    log_density = library.performance.log_density(0, 1.0)
    assert player.belief == pytest.approx(np.exp(log_density) / np.exp(log_density).sum())
    assert player.select() == 0


def test_the_floor_is_no_zero():
    raised = np.exp(floored(np.array([0.0, -np.inf]), 0.01))
    assert raised.tolist() == pytest.approx([1 / 1.01, 0.01 / 1.01])
    assert floored(np.array([0.0, -np.inf]), 0.0).tolist() == [0.0, -np.inf]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"n_policies": 2}, "n_policies must be the library's 3, got 2"),
        ({"floor": 0.6}, r"floor must lie in \[0, 1/2\], got 0.6"),
        ({"floor": -0.1}, "floor must lie in"),
        ({"window": -1}, "window must be at least 0"),
        ({"threshold": 1.1}, r"threshold in \[0, 1\], got 10 and 1.1"),
    ],
)
def test_bad_settings(settings, said):
    with pytest.raises(InputError, match=said):
        BPRPlus(**{"n_policies": 3, "library": PolicyLibrary.from_means(MEAN, 0.1), **settings})
