"""LinUCB: ridge regression worked by hand, the naive twin, what a library gives it."""

from math import sqrt

import numpy as np
import pytest

from lifelore.interaction.baselines import LinUCB
from lifelore.interaction.library.policy_library import PolicyLibrary


def solved(matrix, right):
    """x with `matrix` x = `right`, by elimination in plain Python; for positive definite matrices."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    for place, row in enumerate(rows):
        for other in rows:
            if other is not row:
                factor = other[place] / row[place]
                other[:] = [left - factor * own for left, own in zip(other, row, strict=True)]
    return [row[-1] / row[place] for place, row in enumerate(rows)]


def dot(left, right):
    return sum(a * b for a, b in zip(left, right, strict=True))


def naive_scores(features, noise, alpha, ridge, played):
    """The scores after `played` policies and payoffs: A and b are summed up anew."""
    features = [[value / noise for value in row] for row in features]
    n = len(features[0])
    a = [[ridge * (i == j) for j in range(n)] for i in range(n)]
    b = [0.0] * n
    for policy, paid in played:
        for i in range(n):
            b[i] += features[policy][i] * paid / noise
            for j in range(n):
                a[i][j] += features[policy][i] * features[policy][j]
    weights = solved(a, b)
    return [noise * (dot(row, weights) + alpha * sqrt(dot(row, solved(a, row)))) for row in features]


def test_a_naive_linucb_has_the_same_scores():
    random = np.random.default_rng(2)
    features, paid = random.normal(size=(6, 3)), random.normal(size=(40, 6))
    player = LinUCB(6, features=features, noise=0.7, alpha=1.3, ridge=0.4, seed=1)
    played = []
    for row in paid:
        expected = naive_scores(features.tolist(), 0.7, 1.3, 0.4, played)
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
