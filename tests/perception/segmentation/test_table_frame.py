"""From the sensor's frame to the scene's: known poses by hand, and the planes of real scenes."""

import csv
import os
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from lifelore.core.cloud_origin import SensorFrame
from lifelore.core.errors import InputError
from lifelore.perception import PointCloud, read_cloud, to_scene
from lifelore.perception.clouds.voxel import thinned
from lifelore.perception.segmentation.region import Region
from lifelore.perception.segmentation.table_frame import segmented_scene, table_plane, upright


def table_top(rng, height=0.0):
    """A table of one square metre and a box of 10 × 10 × 20 cm on it, z up; points and labels."""
    table = rng.uniform([-0.5, -0.5, 0], [0.5, 0.5, 0], (3000, 3))
    table = table[(np.abs(table[:, :2]) > 0.06).any(axis=1)]
    box = rng.uniform([-0.05, -0.05, 0], [0.05, 0.05, 0.2], (3000, 3))
    face = rng.integers(0, 3, 3000)
    box[face == 0, 0], box[face == 1, 1], box[face == 2, 2] = 0.05, -0.05, 0.2
    labels = np.repeat([1, 2], [len(table), len(box)])
    return np.concatenate([table, box]) + np.array([0, 0, height]), labels


CAMERA = np.array([0.2, -1.0, 0.8])


def seen(points):
    """The same points in the frame of a camera at CAMERA that looks at the table: x right, y down, z forward."""
    forward = -CAMERA / np.linalg.norm(CAMERA)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    return (points - CAMERA) @ np.stack([right, np.cross(forward, right), forward]).T


@pytest.mark.parametrize("labelled", [True, False])
def test_a_table_seen_by_a_camera_is_set_upright(labelled):
    points, labels = table_top(np.random.default_rng(1))
    cloud = PointCloud(seen(points), labels if labelled else None, camera=np.zeros(3))
    scene = to_scene(cloud)
    # Without labels the lowest centimetre of the box counts as table and lifts the plane by a trifle.
    near = 1e-6 if labelled else 5e-4
    np.testing.assert_allclose(scene.points[:, 2], points[:, 2], atol=near)
    assert scene.camera[2] == pytest.approx(0.8, abs=3 * near)
    # x and y are the camera's right and away: the distances in the plane are kept, the axes turned.
    np.testing.assert_allclose(np.linalg.norm((scene.points - scene.camera)[:, :2], axis=1),
                               np.linalg.norm((points - CAMERA)[:, :2], axis=1), atol=3 * near)  # fmt: skip
    assert (scene.points[:, 1] > scene.camera[1]).all()
    assert scene.objects == (2,)


def test_points_of_a_scene_lead_back_to_the_pixels_and_the_frame_of_the_cloud(monkeypatch):
    points, labels = table_top(np.random.default_rng(3))
    points, labels = points[: len(points) // 50 * 50], labels[: len(points) // 50 * 50]
    cloud = PointCloud(
        seen(points), labels, grid=(len(points) // 50, 50), camera=np.zeros(3), frame=SensorFrame("eye", 3.5)
    )
    cloud.points[::7] = np.nan
    near = Region(max_range=1.4)
    for given in (cloud, replace(cloud, labels=None), replace(cloud, grid=None)):
        scene = segmented_scene(given, region=near).cloud
        origin = scene.origin
        assert origin.frame == ("eye", 3.5)
        assert origin.rows is not None
        assert 0 < len(origin.rows) < np.count_nonzero(cloud.measured)
        np.testing.assert_allclose(origin.in_camera(scene.points), cloud.points[origin.rows], atol=1e-12)
        np.testing.assert_allclose(origin.T_camera_scene, np.linalg.inv(origin.T_scene_camera), atol=1e-12)
        if given.grid is None:
            assert origin.pixels is None
        else:
            assert origin.pixels is not None
            assert (origin.pixels @ [50, 1] == origin.rows).all()
    monkeypatch.setattr("lifelore.perception.segmentation.table_frame.thinned", partial(thinned, at_most=1000))
    assert to_scene(cloud).origin.rows is None


def test_the_side_of_the_objects_is_up_even_when_the_camera_is_said_to_be_below():
    points, labels = table_top(np.random.default_rng(2), height=0.7)
    for given in (labels, None):
        plane = table_plane(PointCloud(points, given, camera=np.zeros(3)))
        assert plane.normal[2] == pytest.approx(1, abs=1e-6)
        assert plane.offset == pytest.approx(-0.7, abs=1e-6 if given is labels else 5e-4)


def test_a_bare_table_faces_its_camera():
    points, labels = table_top(np.random.default_rng(3))
    plane = table_plane(PointCloud(points[labels == 1], camera=np.array([0.0, 0, -1])))
    assert plane.normal[2] == pytest.approx(-1, abs=1e-6)


def test_z_keeps_the_axes_and_lowers_the_table_to_nought():
    points, labels = table_top(np.random.default_rng(4), height=0.7)
    for given in (labels, None):
        scene = to_scene(PointCloud(points, given), up="z")
        np.testing.assert_allclose(scene.points, points - [0, 0, 0.7], atol=1e-9)


def test_z_without_a_table_leaves_the_heights():
    points, labels = table_top(np.random.default_rng(5), height=0.7)
    box = labels == 2
    scene = to_scene(PointCloud(points[box], labels[box]), up="z")
    np.testing.assert_array_equal(scene.points, points[box])


def test_a_vector_of_any_length_is_up():
    points, labels = table_top(np.random.default_rng(6), height=0.3)
    turned = points[:, [2, 0, 1]]  # z became x
    scene = to_scene(PointCloud(turned, labels), up=(5, 0, 0))
    np.testing.assert_allclose(scene.points[:, 2], points[:, 2] - 0.3, atol=1e-9)


def test_a_vector_without_a_table_puts_the_lowest_points_at_nought():
    points, labels = table_top(np.random.default_rng(7), height=0.3)
    box = labels == 2
    scene = to_scene(PointCloud(points[box], labels[box]), up=[0, 0, 1])
    assert abs(np.percentile(scene.points[:, 2], 1)) < 1e-12


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 0, 0), (-1, 0, 0), (0.6, 0, 0.8), (0, -0.75, -0.66)])
def test_upright_is_a_rotation_that_raises_the_normal(normal):
    normal = np.array(normal) / np.linalg.norm(normal)
    rotation = upright(normal)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)
    np.testing.assert_allclose(rotation @ normal, [0, 0, 1], atol=1e-12)


@pytest.mark.parametrize("up", ["up", (0, 0, 0), (1, 2), (0, np.nan, 1), None, "zz"])
def test_another_up_is_refused(up):
    points, labels = table_top(np.random.default_rng(8))
    with pytest.raises(InputError, match="up must be"):
        to_scene(PointCloud(points, labels), up=up)


def test_objects_alone_do_not_tell_up():
    points, labels = table_top(np.random.default_rng(9))
    box = labels == 2
    with pytest.raises(InputError, match="--up X,Y,Z"):
        to_scene(PointCloud(points[box], labels[box]))


@pytest.mark.parametrize("points", [np.full((4, 3), np.nan), np.empty((0, 3))])
def test_nothing_measured_is_refused(points):
    with pytest.raises(InputError, match="no finite point"):
        to_scene(PointCloud(points))


def test_identical_points_are_refused_or_one_scene():
    same = PointCloud(np.ones((1000, 3)))
    with pytest.raises(InputError, match="no table"):
        to_scene(same)
    assert len(to_scene(same, up="z").points) == 1000


@pytest.mark.slow
@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
@pytest.mark.parametrize("scene", ["learn0", "learn25", "learn38", "test47"])
def test_planes_of_real_scenes(scene):
    folder = Path(os.environ["LIFELORE_DATA"]) / "osd"
    with (folder / "planes.csv").open() as file:
        row = next(row for row in csv.DictReader(file) if row["scene"] == scene)
    normal = np.array([float(row[name]) for name in ("nx", "ny", "nz")])
    cloud = read_cloud(folder / f"{scene}.pcd")
    bare = PointCloud(cloud.points, None, cloud.colours, cloud.grid, cloud.camera)
    for given in (cloud, bare):
        plane = table_plane(given)
        # A fifth of a degree tilts a height by 1.7 mm across half a table, the sensor's own noise.
        assert plane.normal @ normal > np.cos(np.radians(0.2))
        assert plane.offset == pytest.approx(float(row["d"]), abs=0.001)
