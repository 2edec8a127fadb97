"""Assignment to motions: by hand, and against all assignments."""

from itertools import product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from reproduction.chapter5.c5_07_poking.motion_labels import motion_labels


def energy(costs, pairs, weights, labels):
    cut = sum(w for (a, b), w in zip(pairs, weights, strict=True) if labels[a] != labels[b])
    return sum(costs[k, m] for k, m in enumerate(labels)) + cut


def test_an_undecided_patch_follows_its_longer_border():
    costs = np.array([[0.0, 9.0], [0.0, 0.0], [9.0, 0.0]])
    pairs = np.array([[0, 1], [1, 2]])
    assert motion_labels(costs, pairs, np.array([1.0, 2.0])).tolist() == [0, 1, 1]
    assert motion_labels(costs, pairs, np.array([2.0, 1.0])).tolist() == [0, 0, 1]


@given(st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_two_motions_are_assigned_at_least_cost(seed):
    # With two motions an expansion move reaches every assignment, so the minimum is found.
    rng = np.random.default_rng(seed)
    costs = rng.integers(0, 6, (6, 2)).astype(float)
    pairs = np.array([(a, b) for a in range(6) for b in range(a + 1, 6) if rng.random() < 0.5]).reshape(-1, 2)
    weights = rng.integers(0, 4, len(pairs)).astype(float)
    best = min(energy(costs, pairs, weights, labels) for labels in product(range(2), repeat=6))
    assert energy(costs, pairs, weights, motion_labels(costs, pairs, weights)) == best


def test_several_motions_are_within_twice_the_least_cost():
    # Expansion moves end within twice the optimum for borders of one weight (Boykov et al. 2001).
    rng = np.random.default_rng(3)
    for _ in range(10):
        costs = rng.integers(1, 6, (5, 3)).astype(float)
        pairs = np.array([(0, 1), (1, 2), (2, 3), (3, 4), (0, 4)])
        weights = np.ones(5)
        best = min(energy(costs, pairs, weights, labels) for labels in product(range(3), repeat=5))
        assert energy(costs, pairs, weights, motion_labels(costs, pairs, weights)) <= 2 * best
