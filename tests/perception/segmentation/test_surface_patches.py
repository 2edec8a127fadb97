"""Flat patches and the noise of their bands: planes put there by hand."""

import numpy as np
import pytest

from lifelore.perception.segmentation.plane import Plane
from lifelore.perception.segmentation.range_noise import band
from lifelore.perception.segmentation.surface_patches import oriented_voxels, patches, plane_of

RNG = np.random.default_rng(1)
FLOOR = RNG.uniform([0, 0, 0], [1.0, 1.0, 0], (20_000, 3))
WALL = RNG.uniform([0, 1, 0], [1.0, 1, 0.6], (12_000, 3))
APART = RNG.uniform([1.5, 0, 0], [1.9, 1.0, 0], (8000, 3))


def found(points, free=None):
    free = np.ones(len(points), bool) if free is None else free
    voxels = oriented_voxels(points, None, free)
    return patches(voxels, np.random.default_rng(0))


def test_a_floor_in_two_pieces_and_a_wall():
    floor, apart, wall = sorted(found(np.concatenate([FLOOR, WALL, APART])), key=lambda p: abs(p.plane.normal[1]))
    floor, apart = sorted((floor, apart), key=lambda patch: -patch.area)
    assert [abs(p.plane.normal[2]) for p in (floor, apart)] == pytest.approx([1, 1], abs=1e-4)
    assert abs(wall.plane.normal[1]) == pytest.approx(1, abs=1e-4)
    # Voxels of 2 cm along the border are counted whole, and those at the crease belong to either plane or none.
    assert [p.area for p in (floor, apart, wall)] == pytest.approx([1.0, 0.4, 0.6], rel=0.1)
    assert apart.covers(np.array([[1.7, 0.5, 0.3], [0.5, 0.5, 0.0]])).tolist() == [True, False]


def test_only_free_points_make_patches():
    points = np.concatenate([FLOOR, WALL])
    (wall,) = found(points, np.arange(len(points)) >= len(FLOOR))
    assert abs(wall.plane.normal[1]) == pytest.approx(1, abs=1e-4)


def test_the_band_grows_with_the_square_of_the_range():
    points = np.array([[0, 0, 0.5], [0, 0, 2.0], [0, 0, 4.0]])
    assert band(points, np.zeros(3)) == pytest.approx([0.010, 0.024, 0.096])
    assert band(points, np.array([0, 0, 1.0])) == pytest.approx([0.010, 0.010, 0.054])
    assert band(points, None).tolist() == [0.010] * 3


def test_a_weighted_plane_follows_the_weights():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1]])
    plane = plane_of(corners, np.array([1, 1, 1, 1, 1e-12]), Plane(np.array([0, 0, -1.0]), 0.0))
    np.testing.assert_allclose([*plane.normal, plane.offset], [0, 0, -1, 0], atol=1e-9)
