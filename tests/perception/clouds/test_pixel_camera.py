"""The camera of an organised cloud: pinhole images drawn by hand, moved to other frames."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.perception import CameraIntrinsics, PointCloud, read_cloud
from lifelore.perception.clouds.pixel_camera import camera_from_pixels

DATA = Path(os.environ.get("LIFELORE_DATA", "nowhere")) / "osd"
PINHOLE = CameraIntrinsics(64, 48, 60.0, 55.0, 30.0, 25.0)
TURN = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
TURN = TURN * np.sign(np.linalg.det(TURN))
PLACE = np.array([0.4, -1.2, 0.9])


def moved(cloud):
    """The cloud in a frame in which its camera is at PLACE, without that knowledge."""
    return replace(cloud, points=cloud.points @ TURN.T + PLACE, camera=None)


def depth_image(rng, noise=0.0):
    """A wall at 1 m with a block before it."""
    depth = np.full((48, 64), 1.0)
    depth[15:35, 20:45] = 0.8
    return depth + rng.normal(0, noise, depth.shape) if noise else depth


def test_the_lines_of_sight_meet_in_the_camera_whatever_the_noise_of_the_depth():
    rng = np.random.default_rng(0)
    for noise in (0.0, 0.02):
        cloud = moved(PointCloud.from_depth(depth_image(rng, noise), PINHOLE))
        np.testing.assert_allclose(camera_from_pixels(cloud), PLACE, atol=1e-6)
        part = cloud.only(rng.random(len(cloud.points)) < 0.5)  # keeps the pixels of its points
        np.testing.assert_allclose(camera_from_pixels(part), PLACE, atol=1e-6)


def test_where_the_camera_cannot_be_told():
    seen = moved(PointCloud.from_depth(depth_image(np.random.default_rng(0)), PINHOLE))
    flat = moved(PointCloud.from_depth(np.full((48, 64), 1.0), PINHOLE))
    turn, rise = np.meshgrid(np.linspace(-1.5, 1.5, 64), np.linspace(-0.5, 0.5, 48))
    ranges = depth_image(np.random.default_rng(0))
    lidar = ranges[..., None] * np.stack(
        [np.cos(turn) * np.cos(rise), np.sin(turn) * np.cos(rise), np.sin(rise)], axis=-1
    )
    assert camera_from_pixels(flat) is None
    assert camera_from_pixels(PointCloud(lidar.reshape(-1, 3), grid=(48, 64))) is None
    assert camera_from_pixels(PointCloud(seen.points)) is None  # not organised
    assert camera_from_pixels(seen.only(np.arange(len(seen.points)) < 50)) is None


@pytest.mark.skipif(not DATA.exists(), reason="needs LIFELORE_DATA/osd")
def test_a_real_camera_is_found_to_the_millimetre():
    for path in sorted(DATA.glob("*.pcd"))[::5]:
        np.testing.assert_allclose(camera_from_pixels(moved(read_cloud(path))), PLACE, atol=1e-3)
