"""Upright boxes: a known pose comes back, no turned rectangle is smaller, and thin or single points have a box."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.core.cloud_origin import CloudOrigin
from lifelore.perception.places.object_box import upright_box


def turned(yaw: float) -> np.ndarray:
    """(3, 3): rows are the axes of a frame that is turned by `yaw` about z."""
    return np.array([[np.cos(yaw), np.sin(yaw), 0], [-np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])


@pytest.mark.parametrize("yaw", [-1.2, 0.0, 0.3, 1.5])
def test_a_box_of_known_pose_comes_back(yaw, box):
    axes, centre = turned(yaw), np.array([0.4, -0.2, 0.15])
    points = box([-0.1, -0.03, -0.05], [0.1, 0.03, 0.05]) @ axes + centre
    found = upright_box(points)
    assert found.centre == pytest.approx(centre)
    assert found.size == pytest.approx([0.2, 0.06, 0.1])
    assert found.axes == pytest.approx(axes)


def test_in_the_frame_of_the_camera_it_is_the_same_box(box):
    axes, pose = turned(0.3), np.eye(4)
    pose[:3, :3] = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    pose[:3, 3] = 0.1, 2, -1
    points = box([0, 0, 0], [0.2, 0.06, 0.1]) @ axes
    origin = CloudOrigin(pose)
    seen = upright_box(points).in_camera(origin)
    within = (origin.in_camera(points) - seen.centre) @ seen.axes.T
    assert np.abs(within).max(axis=0) == pytest.approx(seen.size / 2)


@given(st.integers(0, 10**6), st.integers(3, 40))
def test_no_turned_rectangle_is_smaller_and_all_points_are_inside(seed, n):
    points = np.random.default_rng(seed).normal(size=(n, 3)) * [0.1, 0.03, 0.05]
    found = upright_box(points)
    assert (np.abs((points - found.centre) @ found.axes.T) <= found.size / 2 + 1e-12).all()
    assert found.axes @ found.axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(found.axes) == pytest.approx(1)
    assert found.size[0] >= found.size[1]
    tried = [np.ptp(points @ turned(yaw).T, axis=0)[:2].prod() for yaw in np.linspace(0, np.pi / 2, 91)]
    assert found.size[:2].prod() <= min(tried) + 1e-12


@pytest.mark.parametrize(
    ("points", "size"),
    [
        ([[1, 2, 3]], [0, 0, 0]),
        ([[1, 2, 3]] * 5, [0, 0, 0]),
        ([[0, 0, 0], [0, 0, 2]], [0, 0, 2]),
        ([[0, 0, 0], [3, 4, 1]], [5, 0, 1]),
        ([[0, 0, 0], [3, 4, 1], [-3, -4, 0]], [10, 0, 1]),
        ([[0, 5, 0], [0, 2, 1], [0, 4, 0], [0, 3, 3]], [3, 0, 3]),
        ([[0, 0, 0], [3, 4, 1], [-3, -4, 0], [1.5, 2 + 1e-13, 0], [0.3, 0.4 - 1e-15, 0]], [10, 0, 1]),
    ],
)
def test_points_without_a_footprint_have_a_flat_box(points, size):
    found = upright_box(np.array(points, float))
    assert found.size == pytest.approx(size, abs=1e-9)
    assert found.axes @ found.axes.T == pytest.approx(np.eye(3))
