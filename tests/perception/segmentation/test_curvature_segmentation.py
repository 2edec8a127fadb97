"""Segmentation by curvature: smooth surfaces stay whole, edges and creases cut."""

import numpy as np
import pytest

from lifelore.perception.segmentation.curvature_segmentation import curvature, smooth_surfaces
from lifelore.perception.segmentation.surface_voxels import surface_voxels

CAMERA = np.array([0.3, -0.9, 0.7])
LEAST = 6e-4


def cap(radius, middle=(0, 0, 0.2)):
    """The half of a sphere that faces the camera."""
    rng = np.random.default_rng(1)
    away = rng.normal(size=(60_000, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    return (np.array(middle) + radius * away)[away @ CAMERA > 0]


def sheet(low, high, spacing=0.002):
    steps = [np.arange(a, b + spacing / 2, spacing) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*steps, indexing="ij"), -1).reshape(-1, 3)


@pytest.mark.parametrize("radius", [0.05, 0.1])
def test_the_curvature_of_a_sphere_is_one_over_its_radius(radius):
    surface = surface_voxels(cap(radius), CAMERA, 0.005, 100_000)
    assert np.median(curvature(surface)) == pytest.approx(1 / radius, rel=0.25)


def test_a_plane_has_no_curvature():
    surface = surface_voxels(sheet((0, 0, 0.1), (0.2, 0.2, 0.1)), CAMERA, 0.005, 100_000)
    np.testing.assert_allclose(curvature(surface), 0, atol=1e-3)


def test_a_ball_is_one_and_a_box_is_a_surface_for_each_face():
    faces = [sheet((0, 0, 0.12), (0.15, 0.1, 0.12)), sheet((0, 0, 0.01), (0.15, 0, 0.12))]
    parts = [*faces, cap(0.06, (0.4, 0, 0.1))]
    labels = np.split(
        smooth_surfaces(np.concatenate(parts), CAMERA, LEAST), np.cumsum([len(p) for p in parts])[:-1]
    )
    of_part = [int(np.bincount(part).argmax()) for part in labels]
    assert sorted(of_part) == [2, 3, 4]
    # The edge of the box goes to the nearer face; the rim of the ball, seen from the side, is rough.
    assert all(np.mean(part == label) > 0.85 for part, label in zip(labels, of_part, strict=True))


@pytest.mark.parametrize("n", [0, 1, 2, 30])
def test_few_points_are_no_surface(n):
    points = np.random.default_rng(n).uniform(0, 0.01, (n, 3))
    assert smooth_surfaces(points, CAMERA, LEAST).tolist() == [0] * n
