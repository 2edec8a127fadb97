"""BPR+: the naive twin of belief, floor and detection; switches, and returns that no type explains."""

from math import exp, pi, sqrt

import numpy as np
import pytest

from lifelore.interaction import BPRPlus, PolicyLibrary

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
