"""Parts of an object beside what stands before it are one object, unless the camera sees between them."""

import numpy as np
import pytest

from lifelore.perception.segmentation.convexity_segmentation import convex_objects
from lifelore.perception.segmentation.free_space import view_from
from lifelore.perception.segmentation.parted_objects import continued_pairs
from tests.perception.segmentation.test_patch_merging import patches

CAMERA = np.array([0.0, -0.9, 0.6])
STEP = 0.002


def face(corner, u, v):
    corner, u, v = (np.asarray(x, float) for x in (corner, u, v))
    a, b = (np.arange(0, np.linalg.norm(side) + 1e-9, STEP) / np.linalg.norm(side) for side in (u, v))
    return (corner + a[:, None, None] * u + b[None, :, None] * v).reshape(-1, 3)


def block(x, y, length, width, height):
    """The top and the front of a block whose lower left front corner stands at (x, y, 0)."""
    top = face((x, y, height), (length, 0, 0), (0, width, 0))
    return np.concatenate([face((x, y, 0), (length, 0, 0), (0, 0, height)), top])


def hidden_behind(points, left, right, y):
    """Which points the camera does not see past an upright post from x = `left` to `right` at depth `y`."""
    along = CAMERA[0] + (points[:, 0] - CAMERA[0]) * (y - CAMERA[1]) / (points[:, 1] - CAMERA[1])
    return (points[:, 1] > y) & (along > left) & (along < right)


BEFORE = face((-0.4, -0.4, 0), (0.8, 0, 0), (0, 0.2, 0))
"""The table before all parts."""


def labels_of(*parts, table=BEFORE):
    points = np.concatenate(parts)
    noisy = points + np.random.default_rng(0).normal(0, 0.0007, points.shape)
    labels = convex_objects(noisy, CAMERA, 6e-4, np.concatenate([noisy, table])).labels
    return np.split(labels, np.cumsum([len(part) for part in parts])[:-1])


POST = block(-0.02, -0.15, 0.04, 0.03, 0.30)


def seen(points):
    return points[~hidden_behind(points, -0.03, 0.03, -0.15)]


def test_the_parts_of_a_block_behind_a_post_are_one_object():
    long, post = labels_of(seen(block(-0.12, 0.0, 0.24, 0.08, 0.08)), POST)
    assert len(np.unique(long)) == 1
    assert np.unique(post).tolist() not in (np.unique(long).tolist(), [0])


@pytest.mark.parametrize("height", [0.05, 0.11])
def test_blocks_of_other_heights_and_fronts_behind_a_post_are_two(height):
    left, right = seen(block(-0.12, 0.0, 0.10, 0.08, 0.08)), seen(block(0.02, 0.03, 0.10, 0.08, height))
    first, second, _ = labels_of(left, right, POST)
    assert np.bincount(first).argmax() != np.bincount(second).argmax()


def test_equal_blocks_with_nothing_before_their_gap_are_two():
    first, second = labels_of(block(-0.12, 0.0, 0.08, 0.08, 0.08), block(0.04, 0.0, 0.08, 0.08, 0.08))
    assert np.bincount(first).argmax() != np.bincount(second).argmax()


def test_equal_blocks_are_two_if_the_camera_sees_the_table_beside_the_post_between_them():
    left, right = block(-0.11, 0.0, 0.08, 0.08, 0.08), block(0.03, 0.0, 0.08, 0.08, 0.08)
    behind = face((-0.4, -0.4, 0), (0.8, 0, 0), (0, 0.8, 0))
    behind = behind[~hidden_behind(behind, -0.02, 0.02, -0.15)]
    first, second, _ = labels_of(left, right, POST, table=behind)
    assert np.bincount(first).argmax() != np.bincount(second).argmax()


def test_continued_pairs_agree_with_matrices_of_all_pairs():
    rng = np.random.default_rng(0)
    middles, regions, large = rng.uniform(0, 0.5, (150, 3)), rng.integers(0, 4, 150), np.array([1, 1, 0, 1], bool)
    normals = np.eye(3)[rng.integers(0, 3, 150)] + rng.normal(0, 0.1, (150, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    apart = middles[None] - middles[:, None]
    off = np.abs(np.einsum("ik,ijk->ij", normals, apart))
    good = (normals @ normals.T >= np.cos(np.radians(15))) & (off <= 0.01) & (off.T <= 0.01)
    good &= (np.linalg.norm(apart, axis=2) <= 0.35) & (regions[:, None] != regions)
    good &= large[regions] & large[regions][:, None]
    good = np.triu(good)
    expected = list(zip(*(rows.tolist() for rows in np.nonzero(good)), strict=True))
    # A wall before everything hides all lines; before a wall behind everything all are free.
    before = face((-0.3, -0.6, 0.1), (0.6, 0, 0), (0, 0, 0.8))
    behind = CAMERA + 6 * (before - CAMERA)
    these = patches(middles, normals, [[0, 1]])
    found = [continued_pairs(these, regions, large, view_from(CAMERA, wall)) for wall in (before, behind)]
    assert len(expected) > 5
    assert found == [expected, []]
