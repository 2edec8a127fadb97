"""Merging of patches, worked by hand."""

import numpy as np

from lifelore.perception.segmentation.cut_confidence import cut_confidence
from lifelore.perception.segmentation.free_space import view_from
from lifelore.perception.segmentation.patch_convexity import evidence, signed_angles, steps
from lifelore.perception.segmentation.patch_merging import absorbed, merged
from lifelore.perception.segmentation.supervoxels import Supervoxels

CHAIN = np.array([[0, 1], [1, 2], [2, 3]])


def patches(middles, normals, pairs, borders=None, counts=None):
    middles, normals = np.array(middles, float), np.array(normals, float)
    return Supervoxels(
        np.arange(len(middles)),
        np.ones(len(middles), np.int64) if counts is None else np.array(counts),
        middles,
        normals / np.linalg.norm(normals, axis=1, keepdims=True),
        np.array(pairs),
        np.ones(len(pairs), np.int64) if borders is None else np.array(borders),
    )


def test_a_ridge_is_positive_and_a_crease_negative():
    # Two faces that meet at x = 0: as a roof, and as a valley.
    roof = patches([[-1, 0, 0], [1, 0, 0]], [[-1, 0, 1], [1, 0, 1]], [[0, 1]])
    valley = patches([[-1, 0, 0], [1, 0, 0]], [[1, 0, 1], [-1, 0, 1]], [[0, 1]])
    assert np.isclose(signed_angles(roof)[0], 90)
    assert np.isclose(signed_angles(valley)[0], -90)
    assert steps(roof).tolist() == steps(valley).tolist() == [0]


def test_a_step_is_the_height_between_level_patches():
    # A level patch beside another; the second is 3 higher. Where it leans, the step is the smaller height.
    up, leaning = [0, 0, 1], [-1, 0, 2]
    assert np.isclose(steps(patches([[0, 0, 0], [4, 0, 3]], [up, up], [[0, 1]]))[0], 3)
    assert np.isclose(steps(patches([[0, 0, 0], [4, 0, 3]], [up, leaning], [[0, 1]]))[0], 2 / np.sqrt(5))


def test_evidence_is_greatest_on_flat_surfaces_and_least_in_creases():
    found = evidence(np.array([-90.0, -40.0, -15.0, 0.0, 90.0, 0.0, 0.0]), np.array([0, 0, 0, 0, 0, 0.5, 9]))
    assert found.tolist() == [-5, -5, 0, 5, 1, 0.5, -5]


def joined(n, pairs, borders, odds):
    """Regions of patches of which no camera is known."""
    found = patches(np.zeros((n, 3)), np.ones((n, 3)), pairs, borders)
    return merged(found, np.array(odds), 0, 0.005, view_from(None, np.empty((0, 3)))).tolist()


def test_regions_end_at_negative_evidence():
    assert joined(4, CHAIN, [1, 1, 1], [2.0, -1.0, 2.0]) == [0, 0, 1, 1]


def test_a_long_crease_outweighs_a_short_leak():
    # 0 and 1 join, 2 and 3 join; between them lie a crease of length 9 and a leak of length 1.
    pairs = np.array([[0, 1], [2, 3], [0, 2], [1, 3]])
    odds = [5.0, 5.0, -1.0, 3.0]
    assert joined(4, pairs, [5, 5, 9, 1], odds) == [0, 0, 1, 1]
    # The mean decides: with the lengths exchanged, all are one.
    assert joined(4, pairs, [5, 5, 1, 9], odds) == [0, 0, 0, 0]


def test_merging_agrees_with_a_slow_twin():
    rng = np.random.default_rng(0)
    for _ in range(30):
        n = 12
        pairs = np.array([(a, b) for a in range(n) for b in range(a + 1, n) if rng.random() < 0.3])
        borders, odds = rng.integers(1, 20, len(pairs)), rng.normal(0, 2, len(pairs))
        assert joined(n, pairs, borders, odds) == slowly_merged(n, pairs, borders, odds).tolist()


def slowly_merged(n, pairs, borders, odds):
    """The regions, every mean computed anew after each merge."""
    region = np.arange(n)
    while True:
        best, join = 0.0, None
        for a in np.unique(region):
            for b in np.unique(region):
                between = (region[pairs] == [a, b]).all(axis=1) | (region[pairs] == [b, a]).all(axis=1)
                if a < b and between.any():
                    mean = np.average(odds[between], weights=borders[between])
                    if mean > best:
                        best, join = mean, (a, b)
        if join is None:
            # Regions are numbered by the rank of a member that the fast version chooses: compare as partitions.
            return canonical(region)
        region[region == join[1]] = join[0]


def canonical(region):
    return np.unique([np.flatnonzero(region == r)[0] for r in region], return_inverse=True)[1]


def test_no_patches_that_touch_stay_apart():
    assert joined(3, np.empty((0, 2), np.int64), np.empty(0, np.int64), np.empty(0)) == [0, 1, 2]


def test_weak_regions_join_the_neighbour_of_the_longest_border():
    regions, counts = np.array([0, 1, 2, 3]), np.array([100, 5, 90, 3])

    def small(own):
        voxels = np.bincount(own, counts)
        return np.where(voxels < 10, voxels, np.inf)

    assert absorbed(regions, CHAIN, np.array([2, 7, 1]), small).tolist() == [0, 1, 1, 1]
    # A weak region without neighbours stays.
    assert absorbed(regions, CHAIN[:2], np.array([2, 7]), small).tolist() == [0, 1, 1, 2]


def test_confidence_by_hand():
    # Two regions of two patches each; a border of length 6 and evidence -2 between them.
    pair = patches(np.zeros((4, 3)), [[0, 0, 1]] * 4, CHAIN, [4, 6, 5], [100, 200, 300, 400])
    found = cut_confidence(pair, np.array([5.0, -2.0, -1.0]), np.array([0, 0, 1, 1]))
    odds = [-15.7 + 0.38 * 2 - 0.07 * 6 / np.sqrt(n) + 2.9 * np.log(n) for n in (300, 700)]
    assert np.allclose(found, 1 / (1 + np.exp(-np.array(odds))))
    # One object cut in two is surer than either half.
    assert cut_confidence(pair, np.array([5.0, -2.0, -1.0]), np.zeros(4, int))[0] > found.max()
