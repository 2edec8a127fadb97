"""Warnings: clouds that would be misunderstood without a word, and good clouds that give none."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_scale import in_metres
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.scene_warnings import scene_warnings
from lifelore.perception.segmentation.table_frame import segmented_scene

CAMERA = np.array([0.1, -0.9, 0.7])
FORWARD = -CAMERA / np.linalg.norm(CAMERA)
RIGHT = np.cross(FORWARD, [0, 0, 1]) / np.linalg.norm(np.cross(FORWARD, [0, 0, 1]))
AXES = np.stack([RIGHT, np.cross(FORWARD, RIGHT), FORWARD])
"""A camera that looks 38° down at the origin of a table: x right, y down, z forward."""
TRUE_UP = AXES @ [0, 0, 1]


def faces(x, y, side, height, bottom=0.0, n=2500):
    """The top and the two visible sides of a box."""
    rng = np.random.default_rng(int(1000 * (x + y + 3)))
    points = rng.uniform([x, y, bottom], [x + side, y + side, bottom + height], (n, 3))
    face = rng.integers(0, 3, n)
    points[face == 0, 1], points[face == 1, 0], points[face == 2, 2] = y, x + side, bottom + height
    return points


TABLE = np.random.default_rng(1).uniform([-0.5, -0.4, 0], [0.5, 0.4, 0], (12_000, 3))
BOXES = [faces(-0.2, 0.0, 0.1, 0.15), faces(0.1, -0.1, 0.08, 0.08)]


def is_visible(points):
    """(n,) bool: whether no box stands between a point and the camera."""
    free = np.ones(len(points), bool)
    for box in BOXES:
        low, high = box.min(axis=0) + 1e-6, box.max(axis=0) - 1e-6
        with np.errstate(divide="ignore"):
            ends = np.stack([low - points, high - points]) / (CAMERA - points)
        enter, leave = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
        free &= (enter >= leave) | (leave <= 1e-6)
    return free


def labels_of(parts):
    return np.repeat(np.arange(1, len(parts) + 1), [len(part) for part in parts])


def seen(points, labels=None):
    """A cloud in the camera's frame: the points that no box hides."""
    free = is_visible(points)
    return PointCloud(
        (points[free] - CAMERA) @ AXES.T, None if labels is None else labels[free], camera=np.zeros(3)
    )


WHOLE = np.concatenate([TABLE, *BOXES])


def codes(scene):
    return [warning.code for warning in scene_warnings(scene)]


def test_a_table_with_boxes_gives_only_the_hint_of_automatic_objects():
    scene = segmented_scene(seen(WHOLE))
    assert len(scene.cloud.objects) == 2
    assert codes(scene) == ["automatic_objects"]


def test_labels_without_a_doubt_give_no_warning():
    assert codes(segmented_scene(seen(WHOLE, labels_of([TABLE, *BOXES])))) == []


def test_z_in_a_camera_frame_finds_no_level_table():
    found = codes(segmented_scene(seen(WHOLE), up="z"))
    assert found[:2] == ["up_not_level", "no_table"]


def test_a_tilted_camera_is_told_the_up_direction_that_fits():
    scene = segmented_scene(seen(WHOLE), up=(0, -1, 0))
    warning = scene_warnings(scene)[0]
    assert warning.code == "up_not_level"
    hint = np.array([float(x) for x in warning.message.rsplit("=", 1)[1].split(",")])
    assert hint @ TRUE_UP / np.linalg.norm(hint) > np.cos(np.radians(1.5))
    level = segmented_scene(seen(WHOLE), up=hint)
    assert codes(level) == ["automatic_objects"]


@pytest.mark.parametrize("per_metre", [100.0, 39.37])
def test_centimetres_and_inches_read_as_millimetres_are_doubted(per_metre):
    cloud = in_metres(PointCloud(seen(WHOLE).points * per_metre, camera=np.zeros(3)), "mm")
    assert codes(segmented_scene(cloud, up=TRUE_UP))[0] == "units"
    with pytest.raises(InputError, match="--units cm"):
        segmented_scene(cloud)


def test_without_any_plane_there_is_no_table():
    fog = PointCloud(np.random.default_rng(3).uniform([-1, -1, 0.5], [1, 1, 2.0], (5000, 3)), camera=np.zeros(3))
    with pytest.raises(InputError, match="no table was found"):
        segmented_scene(fog)
    assert {"up_not_level", "no_table"} <= set(codes(segmented_scene(fog, up=TRUE_UP)))


def test_an_object_alone_is_no_table():
    alone = seen(faces(-0.1, 0.0, 0.2, 0.15, n=6000))
    with pytest.raises(InputError, match="no table was found"):
        segmented_scene(alone)
    scene = segmented_scene(alone, up=TRUE_UP)
    assert "no_table" in codes(scene)
    # Its points are as sparse as their voxels: a sliver may be cut off, which is not sure to be an object.
    assert sum(confidence > 0.5 for confidence in scene.confidence.values()) == 1


def test_a_bare_table_is_empty():
    assert codes(segmented_scene(seen(TABLE))) == ["table_empty"]


def test_a_book_and_a_box_labelled_0_and_1_are_told_how_objects_are_numbered():
    parts = [faces(-0.1, -0.1, 0.2, 0.02, n=8000), faces(-0.05, -0.05, 0.08, 0.1, bottom=0.022)]
    scene = segmented_scene(seen(np.concatenate(parts), 1 - labels_of(parts) // 2), up=TRUE_UP)
    assert not scene.cloud.objects
    told = {warning.code: warning.message for warning in scene_warnings(scene)}
    assert "objects are numbered from 2 (0 is no object, 1 is the table)" in told["table_empty"]


def test_objects_over_the_labelled_table_are_far_from_it():
    parts = [TABLE, faces(-0.2, 0.0, 0.1, 0.1, bottom=0.2)]
    assert codes(segmented_scene(seen(np.concatenate(parts), labels_of(parts)))) == ["table_gap"]


def test_up_that_points_down_puts_objects_below():
    parts = [TABLE, *BOXES]
    assert "table_gap" in codes(segmented_scene(seen(WHOLE, labels_of(parts)), up=-TRUE_UP))


def test_a_table_of_few_points():
    parts = [TABLE[:200], *BOXES]
    assert codes(segmented_scene(seen(np.concatenate(parts), labels_of(parts)))) == ["few_table_points"]


def test_an_object_of_few_points_is_named():
    parts = [TABLE, BOXES[0], BOXES[1][:29]]
    (warning,) = scene_warnings(segmented_scene(seen(np.concatenate(parts), labels_of(parts))))
    assert warning.code == "few_object_points"
    n = np.count_nonzero(is_visible(BOXES[1][:29]))
    assert warning.message.endswith(f"a guess: 3 ({n})")


def test_points_above_the_table_that_became_no_object():
    scene = segmented_scene(seen(WHOLE))
    is_second = scene.cloud.labels == 3
    labels = np.where(is_second, 0, scene.cloud.labels)
    left = replace(scene, cloud=replace(scene.cloud, labels=labels))
    (warning,) = [one for one in scene_warnings(left) if one.code == "points_dropped"]
    above = scene.cloud.points[:, 2] > 0.01
    n, n_above = np.count_nonzero(is_second & above), np.count_nonzero((scene.cloud.labels > 1) & above)
    assert warning.message.startswith(
        f"{n:,} of {n_above:,} points above the table's plane ({100 * n / n_above:.0f} %)"
    )
    low, high = np.percentile(scene.cloud.points[is_second & above], (5, 95), axis=0)
    assert f"belong to no object: x {low[0]:.2f} to {high[0]:.2f}, y" in warning.message


def test_a_table_that_faces_the_camera_may_be_a_wall():
    overhead = PointCloud(np.concatenate([TABLE, BOXES[0][BOXES[0][:, 2] > 0.149]]) * [1, -1, -1] + [0, 0, 1.0])
    overhead = replace(overhead, camera=np.zeros(3))
    assert "table_faces_camera" in codes(segmented_scene(overhead))
    assert "table_faces_camera" not in codes(segmented_scene(overhead, up=(0, 0, -1)))


def test_tiny_objects():
    specks = [faces(0.1 * k, 0.0, 0.01, 0.01, n=200) for k in range(-3, 4)]
    parts = [TABLE, *specks]
    assert codes(segmented_scene(seen(np.concatenate(parts), labels_of(parts)))) == ["tiny_objects"]


def test_a_scene_in_inches_read_as_metres():
    scene = segmented_scene(PointCloud(WHOLE * 15, labels_of([TABLE, *BOXES])))
    (warning,) = [one for one in scene_warnings(scene) if one.code == "units"]
    assert "pass --units inch (0.37 m wide)" in warning.message
