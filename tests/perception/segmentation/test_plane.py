"""Planes: known ones found among other things, and clouds that have none."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.segmentation.plane import Plane, fitted_plane


def slab(rng, normal, offset, n, noise):
    """n points of the plane ``normal · p + offset = 0``, within half a metre, with noise along the normal."""
    normal = np.array(normal) / np.linalg.norm(normal)
    points = rng.uniform(-0.5, 0.5, (n, 3))
    points -= np.outer(points @ normal + offset, normal)
    return points + np.outer(rng.normal(0, noise, n), normal), normal


@pytest.mark.parametrize("normal", [(0, 0, 1), (0.3, -0.8, -0.5), (1, 0, 0)])
def test_a_table_among_clutter(normal):
    rng = np.random.default_rng(4)
    table, normal = slab(rng, normal, 0.6, 3000, 0.002)
    clutter = rng.uniform(-0.5, 0.5, (2000, 3)) - 0.6 * normal
    plane = fitted_plane(np.concatenate([table, clutter]))
    # 3000 points of 2 mm noise fix the height to 2 mm / √3000 and the tilt to that over 0.29 m: 0.04 mm, 0.007°.
    # The clutter inside the band is even about the plane and widens that a little; ten times both is allowed.
    assert abs(plane.normal @ normal) > np.cos(np.radians(0.07))
    assert abs(plane.offset) == pytest.approx(0.6, abs=0.0004)


@pytest.mark.parametrize("part", ["shelf", "front"])
def test_what_else_is_labelled_as_table_does_not_tilt_it(part):
    boxes = {"shelf": ([-0.5, 0, -0.41], [0.5, 0.3, -0.4]), "front": ([-0.5, -0.31, -0.7], [0.5, -0.3, 0])}
    rng = np.random.default_rng(5)
    top = rng.uniform([-0.5, -0.3, -0.001], [0.5, 0.3, 0.001], (3000, 3))
    plane = fitted_plane(np.concatenate([top, rng.uniform(*boxes[part], (2400, 3))]))
    assert abs(plane.normal[2]) > np.cos(np.radians(0.2))


@pytest.mark.parametrize(
    "points",
    [
        np.empty((0, 3)),
        np.ones((2, 3)),
        np.ones((50, 3)),
        np.outer(np.linspace(0, 1, 50), [1.0, 2.0, 3.0]),
        np.random.default_rng(7).uniform(-1, 1, (5000, 3)),
    ],
    ids=["none", "two", "identical", "a line", "a cube of fog"],
)
def test_where_no_plane_is_none_is_found(points):
    with pytest.raises(InputError, match="no plane"):
        fitted_plane(points)


def test_height_and_the_other_side():
    plane = Plane(np.array([0.0, 0, 1]), 0.5)
    assert plane.height(np.array([[7.0, 8.0, 0.25]])).tolist() == [0.75]
    assert plane.flipped().height(np.array([[7.0, 8.0, 0.25]])).tolist() == [-0.75]
