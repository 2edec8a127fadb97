"""X-means: the criterion by hand, clusters found, k-means at its own number, and where the paper slips."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import multivariate_normal
from sklearn.cluster import KMeans
from sklearn.metrics import adjusted_rand_score

from reproduction.chapter2.c2_12_unlabelled_relations.x_means import bayesian_criterion, x_means

LINE = np.array([[0.0], [2.0], [10.0], [12.0]])
CENTRES = np.array([[1.0], [11.0]])
HALVES = np.array([0, 0, 1, 1])


def blobs(k: int, dimensions: int = 3, each: int = 80) -> tuple[np.ndarray, np.ndarray]:
    """`k` round clusters of deviation 0.3 with centres 5 apart."""
    rng = np.random.default_rng(k)
    # Corners of a grid, so that the clusters are apart whatever the seed.
    centres = 5.0 * np.stack(np.unravel_index(rng.permutation(3**dimensions)[:k], (3,) * dimensions), axis=1)
    points = np.concatenate([centre + 0.3 * rng.normal(size=(each, dimensions)) for centre in centres])
    return points, np.repeat(np.arange(k), each)


def test_criterion_by_hand():
    # S = 4, R = 4, M = 1, K = 2: sigma^2 = 1, and p = 1 + 2 + 1 = 4.
    expected = 4 * np.log(0.5) - 2 * (np.log(2 * np.pi) + 1) - 2 * np.log(4)
    assert bayesian_criterion(LINE, CENTRES, HALVES) == pytest.approx(expected)


@pytest.mark.parametrize(("k", "dimensions"), [(1, 1), (1, 3), (2, 2), (4, 3)])
def test_the_corrected_criterion_is_the_mixtures_own_likelihood(k, dimensions):
    points, labels = (
        blobs(k, dimensions) if dimensions > 1 else (np.random.default_rng(0).normal(size=(50, 1)), None)
    )
    labels = np.zeros(len(points), np.int64) if labels is None else labels
    centres = np.array([points[labels == n].mean(axis=0) for n in range(k)])
    variance = ((points - centres[labels]) ** 2).mean()
    likelihood = sum(
        np.log(np.mean(labels == n)) + multivariate_normal(centres[n], variance * np.eye(dimensions)).logpdf(point)
        for point, n in zip(points, labels, strict=True)
    )
    parameters = (k - 1) + k * dimensions + 1
    expected = likelihood - parameters / 2 * np.log(len(points))
    assert bayesian_criterion(points, centres, labels) == pytest.approx(expected)


@pytest.mark.parametrize(("dimensions", "holds"), [(1, True), (3, False)])
def test_the_printed_likelihood_is_one_in_a_single_dimension_only(dimensions, holds):
    """With M = K = 1 it is the likelihood under its own variance; with M = 3 that variance is thrice too large."""
    points = np.random.default_rng(0).normal(size=(200, dimensions))
    centre = points.mean(axis=0)
    variance = ((points - centre) ** 2).sum() / 199
    # Printed to be an estimate of the variance of a coordinate, which is 1.
    assert (abs(variance - 1) < 0.3) == holds
    printed = -200 / 2 * np.log(2 * np.pi) - 200 * dimensions / 2 * np.log(variance) - 199 / 2
    density = multivariate_normal(centre, variance * np.eye(dimensions)).logpdf(points).sum()
    assert (printed == pytest.approx(density)) == holds


@pytest.mark.parametrize("k", [1, 2, 8])
def test_clusters_that_are_apart_are_found(k):
    points, truth = blobs(k)
    found = x_means(points, np.random.default_rng(0))
    assert len(found.centres) == k
    assert adjusted_rand_score(truth, found.labels) == 1


@pytest.mark.slow
@settings(deadline=None, max_examples=8)
@given(st.integers(0, 10_000), st.integers(5, 60))
def test_what_is_found_is_a_fixed_point_of_k_means(seed, n):
    points = np.random.default_rng(seed).normal(size=(n, 2))
    found = x_means(points, np.random.default_rng(seed), most=min(n, 8))
    twin = KMeans(len(found.centres), init=found.centres, n_init=1, tol=0).fit(points)
    assert (twin.labels_ == found.labels).all()
    assert twin.cluster_centers_ == pytest.approx(found.centres)
    assert found.criterion == pytest.approx(bayesian_criterion(points, found.centres, found.labels))
    assert set(found.labels.tolist()) == set(range(len(found.centres)))


def test_a_ring_of_displacements_is_cut_at_random_and_a_relation_in_both_orders_is_two():
    # Errata E22. Neighbours in every direction: one relation, but no sphere holds a ring.
    turn = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    ring = 0.06 * np.column_stack([np.cos(turn), np.sin(turn), np.zeros(200)])
    ring += np.random.default_rng(0).normal(0, 0.004, ring.shape)
    cuts = [x_means(ring, np.random.default_rng(seed), most=10).labels for seed in range(2)]
    assert min(cut.max() for cut in cuts) >= 2
    assert adjusted_rand_score(*cuts) < 0.9
    # One object on another, named in either order.
    above = np.random.default_rng(1).normal([0, 0, 0.05], 0.004, (60, 3))
    both = x_means(np.concatenate([above, -above]), np.random.default_rng(0), most=10).labels
    assert set(both[:60]).isdisjoint(both[60:])
