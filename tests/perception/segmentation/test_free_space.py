"""Two blocks that touch stay apart where the camera sees through the space between them."""

import numpy as np

from lifelore.perception.segmentation.convexity_segmentation import convex_objects
from lifelore.perception.segmentation.free_space import free_share, view_from
from tests.perception.segmentation.test_parted_objects import CAMERA, block, face
from tests.perception.segmentation.test_patch_merging import patches

UP = [0.0, 0.0, 1.0]


def test_free_share_by_hand():
    # Two level patches 0.4 apart on a table 1 m below the camera. All of the line is on the table; a line between
    # two that stand 0.1 above it is free, but for what a wall before them hides.
    camera = np.array([0.0, 0.0, 1.0])
    table = face((-0.3, -0.1, 0), (0.6, 0, 0), (0, 0.2, 0))
    middles, normals = np.array([[-0.2, 0, 0], [0.2, 0, 0], [-0.2, 0, 0.1], [0.2, 0, 0.1]]), np.array([UP] * 4)

    def share(first, second, seen, normals=normals):
        view = view_from(camera, seen)
        return free_share(np.array(first), np.array(second), patches(middles, normals, [[0, 1]]), 0.005, view)

    assert share([0], [1], table) == 0
    assert share([2], [3], table) == 1
    assert share([0, 2], [1, 3], table) == 3 / 4
    half = face((0.05, -0.1, 0.5), (0.2, 0, 0), (0, 0.2, 0))
    assert share([2], [3], np.concatenate([table, half])) == 2 / 3

    # Patches that face each other, as across the inside of a bowl.
    inside = np.array([UP, UP, [1.0, 0, 0], [-1.0, 0, 0]])
    assert share([2], [3], table, inside) == 0


def test_a_block_that_overhangs_another_is_an_object_of_its_own():
    # Their fronts are flush. Below the end of the upper one and above that of the lower one is free space.
    front = face((0.02, 0.0, 0.05), (0.12, 0, 0), (0, 0, 0.05))
    upper = np.concatenate([front, face((0.02, 0.0, 0.10), (0.12, 0, 0), (0, 0.1, 0))])
    points = np.concatenate([block(-0.06, 0.0, 0.12, 0.10, 0.05), upper])
    points += np.random.default_rng(0).normal(0, 0.0007, points.shape)
    table = face((-0.4, -0.4, 0), (0.8, 0, 0), (0, 1.0, 0))
    labels = convex_objects(points, CAMERA, 6e-4, np.concatenate([points, table])).labels
    n = len(upper)
    assert np.bincount(labels[-n:]).argmax() != np.bincount(labels[:-n]).argmax()


def test_a_flush_block_on_a_longer_one_is_an_object_of_its_own():
    # Their fronts are one plane. A little free space beside the upper one is enough, as it ends higher.
    upper = [face((-0.04, 0, 0.06), (0.1, 0, 0), (0, 0, 0.04)), face((-0.04, 0, 0.1), (0.1, 0, 0), (0, 0.08, 0))]
    points = np.concatenate([block(-0.06, 0.0, 0.14, 0.1, 0.06), *upper])
    points += np.random.default_rng(0).normal(0, 0.001, points.shape)
    table = face((-0.4, -0.4, 0), (0.8, 0, 0), (0, 1.0, 0))
    labels = convex_objects(points, CAMERA, 6e-4, np.concatenate([points, table])).labels
    n = len(upper[0]) + len(upper[1])
    lower = np.bincount(labels[:-n]).argmax()
    assert np.bincount(labels[-n:]).argmax() != lower
    assert (labels[:-n] == lower).mean() > 0.95
    assert (labels[-n:] == lower).mean() < 0.1
