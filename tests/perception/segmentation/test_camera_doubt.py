"""Cameras that cannot be where they are said to be, as of clouds in a robot's frame, and cameras that can."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.perception import PointCloud, read_cloud
from lifelore.perception.segmentation.camera_doubt import camera_at_origin, camera_doubt, share_behind
from lifelore.perception.segmentation.scene_warnings import scene_warnings
from lifelore.perception.segmentation.table_frame import segmented_scene

DATA = Path(os.environ.get("LIFELORE_DATA", "nowhere"))
CLOUDS = sorted([*(DATA / "osd").glob("*.pcd"), *(DATA / "osd_hard").glob("*.pcd")])
needs_data = pytest.mark.skipif(not CLOUDS, reason="needs LIFELORE_DATA/osd")


def wall(depth, side=0.4, step=0.004):
    """A wall across the z axis; from the origin its points are 4 mrad apart at 1 m."""
    across = np.arange(-side, side, step)
    return np.stack(np.meshgrid(across, across, [depth]), axis=-1).reshape(-1, 3)


def behind(points):
    rays = points.astype(np.float32)
    return share_behind(rays, np.linalg.norm(rays, axis=1))


def test_a_wall_behind_half_of_a_wall():
    """The far wall's points behind the near half are half of its points in a cell with a nearer one."""
    front = wall(1.0, step=0.002)
    back = wall(1.2, step=0.002) * [1.2, 1.2, 1.0]
    share = behind(np.concatenate([front[front[:, 0] < 0], back]))
    expected = np.mean(back[:, 0] < 0) * len(back) / (len(back) + len(front) / 2)
    assert share == pytest.approx(expected, abs=0.03)
    assert behind(np.concatenate([front[front[:, 0] < 0], back[back[:, 0] >= 0]])) < 0.01


def test_a_camera_among_its_points_is_doubted():
    points = np.concatenate([wall(1.0), wall(0.1, 0.05)])
    assert "within 15 cm" in str(camera_doubt(points, np.zeros(3)))
    assert camera_doubt(wall(1.0), np.zeros(3)) is None
    assert camera_doubt(wall(0.1, 0.05), np.zeros(3)) is None  # small as a whole: other units, perhaps


def test_a_camera_below_the_table_counts_as_unknown():
    table = wall(0.0, step=0.008)
    block = wall(0.1, side=0.05) + np.array([0.5, 0, 0])
    labels = np.repeat([1, 2], [len(table), len(block)])
    scene = segmented_scene(
        PointCloud(np.concatenate([table, block]), labels, camera=np.array([1.5, 0.0, -0.3])), up="z"
    )
    assert scene.cloud.camera is None
    assert scene.camera_doubt == "it would be 0.30 m below the table"
    (warning,) = [one for one in scene_warnings(scene) if one.code == "camera_doubted"]
    assert "counts as unknown" in warning.message


@needs_data
def test_no_true_camera_is_doubted():
    assert len(CLOUDS) == 36
    for path in CLOUDS:
        cloud = read_cloud(path)
        assert cloud.camera is not None
        assert camera_doubt(cloud.points[cloud.measured].astype(float), cloud.camera) is None, path.name


@needs_data
def test_points_in_a_cameras_own_frame_are_seen_from_the_origin():
    """Without pixels and without a camera, as in many PLY files, a cloud is cut as with its camera."""
    cloud = read_cloud(DATA / "osd" / "learn21.pcd")
    points = cloud.points[cloud.measured]
    unknown = segmented_scene(PointCloud(points))
    known = segmented_scene(PointCloud(points, camera=np.zeros(3)))
    np.testing.assert_array_equal(unknown.cloud.labels, known.cloud.labels)
    assert unknown.camera_doubt is None


def test_a_cloud_that_cannot_be_seen_from_the_origin_has_no_camera_there():
    hidden = np.concatenate([wall(1.0), wall(1.5)])
    below_the_table = np.concatenate([wall(1.0, step=0.008), wall(1.1, 0.05) + np.array([0.2, 0, 0])])
    assert camera_at_origin(wall(1.0)) is not None
    assert camera_at_origin(hidden) is None
    assert camera_at_origin(wall(1.0) - np.array([2.0, 0, 0])) is None
    assert segmented_scene(PointCloud(below_the_table), up="z").cloud.camera is None


def in_base_frame(cloud, base):
    """The cloud in a robot's frame, x forward and z up, with its camera left at the origin.

    `base` is the robot's place in the scene's frame of the cloud.
    """
    scene = segmented_scene(cloud).cloud
    return PointCloud(scene.points - base, None, scene.colours, camera=np.zeros(3))


@needs_data
@pytest.mark.parametrize("base", [(0.0, 0.2, 0.1), (-0.7, 0.8, -0.5), (0.2, 1.6, 0.4)], ids=str)
@pytest.mark.parametrize("name", ["test51", "learn38"])
def test_a_cloud_in_a_robots_frame_with_its_camera_at_the_origin(name, base):
    scene = segmented_scene(in_base_frame(read_cloud(DATA / "osd" / f"{name}.pcd"), np.array(base)))
    assert scene.camera_doubt is not None
    assert scene.cloud.camera is None
    assert "camera_doubted" in [warning.code for warning in scene_warnings(scene)]


@needs_data
@pytest.mark.parametrize("camera", [None, np.zeros(3)], ids=["unknown", "wrong"])
def test_the_pixels_of_an_organised_cloud_tell_where_the_camera_is(camera):
    """In a robot's frame, the scene is cut as in the camera's own."""
    cloud = read_cloud(DATA / "osd" / "learn21.pcd")
    own = segmented_scene(replace(cloud, labels=None))
    to_robot = own.cloud.origin.T_scene_camera
    points = (cloud.points @ to_robot[:3, :3].T + to_robot[:3, 3] - [0.2, 1.6, 0.4]).astype(np.float32)
    scene = segmented_scene(replace(cloud, labels=None, points=points, camera=camera))
    places = [np.linalg.norm(one.cloud.points - one.cloud.camera, axis=1) for one in (own, scene)]
    np.testing.assert_allclose(*places, atol=1e-4)
    codes = [warning.code for warning in scene_warnings(scene)]
    assert ("camera_doubted" in codes) == (camera is not None)
    assert "computed from the pixels" in " ".join(one.message for one in scene_warnings(scene)) or camera is None
    assert len(scene.cloud.objects) == len(own.cloud.objects)


@needs_data
def test_a_doubted_camera_gives_the_scene_without_a_camera():
    cloud = in_base_frame(read_cloud(DATA / "osd" / "test51.pcd"), np.array([0.2, 1.6, 0.4]))
    doubted, unknown = segmented_scene(cloud).cloud, segmented_scene(replace(cloud, camera=None)).cloud
    np.testing.assert_array_equal(doubted.labels, unknown.labels)
