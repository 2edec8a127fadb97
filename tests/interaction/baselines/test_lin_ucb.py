"""LinUCB: the naive twin, what a library gives it."""

import numpy as np
import pytest

from lifelore.interaction import LinUCB, PolicyLibrary


def naive_scores(features, noise, alpha, ridge, played):
    """The scores after `played` policies and payoffs: A and b are summed up anew."""
    features = features / noise
    a = ridge * np.eye(3) + sum(np.outer(features[policy], features[policy]) for policy, _ in played)
    b = sum((features[policy] * paid / noise for policy, paid in played), np.zeros(3))
    return [noise * (x @ np.linalg.solve(a, b) + alpha * np.sqrt(x @ np.linalg.solve(a, x))) for x in features]


def test_a_naive_linucb_has_the_same_scores():
    random = np.random.default_rng(2)
    features, paid = random.normal(size=(6, 3)), random.normal(size=(40, 6))
    player = LinUCB(6, features=features, noise=0.7, alpha=1.3, ridge=0.4, seed=1)
    played = []
    for row in paid:
        expected = naive_scores(features, 0.7, 1.3, 0.4, played)
        assert player._scores()[0] == pytest.approx(expected, rel=1e-9, abs=1e-9)
        policy = player.select()
        assert policy == expected.index(max(expected))
        played.append((policy, float(row[policy])))
        player.update(*played[-1])


def test_a_library_without_noise_keeps_the_precision():
    random = np.random.default_rng(5)
    means = random.normal(size=(3, 6))
    player = LinUCB.from_library(PolicyLibrary.from_means(means, 1e-40))
    for number in range(300):
        player.update(number % 6, means[1, number % 6])
    assert player.posterior()[0][0] == pytest.approx(means[1], abs=1e-6)
    assert player.select() == means[1].argmax()
