"""Segmentation by convexity: shapes made by hand, real scenes against their labels, and invariances."""

import os
from pathlib import Path

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception import PointCloud, read_cloud, to_scene
from lifelore.perception.segmentation.convexity_segmentation import agreement, convex_objects, most_agreed
from lifelore.perception.segmentation.cut_confidence import CutCloud
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings, cut_cloud
from lifelore.perception.segmentation.surface_voxels import surface_voxels
from reproduction.chapter2.scoring.segmentation_scoring import FOUND, overlaps

CAMERA = np.array([0.3, -0.9, 0.7])
STEP, NOISE = 0.002, 0.0005
LEAST = 6e-4


def face(corner, u, v):
    """Points of a parallelogram, `STEP` apart."""
    corner, u, v = (np.asarray(x, float) for x in (corner, u, v))
    a, b = (np.arange(0, np.linalg.norm(side) + 1e-9, STEP) / np.linalg.norm(side) for side in (u, v))
    return corner + a[:, None, None] * u + b[None, :, None] * v


def box(x, y, z, length, width, height):
    """The top, the front and the right side of a box: its faces towards `CAMERA`."""
    faces = [
        face((x, y, z + height), (length, 0, 0), (0, width, 0)),
        face((x, y, z), (length, 0, 0), (0, 0, height)),
        face((x + length, y, z), (0, width, 0), (0, 0, height)),
    ]
    return np.concatenate([part.reshape(-1, 3) for part in faces])


def cylinder(x, y, radius, height):
    """The top and the front half of a standing cylinder."""
    angles = np.arange(-np.pi * 0.85, np.pi * 0.15, STEP / radius)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1) * radius
    z = np.arange(0, height, STEP)
    side = np.column_stack([np.tile(ring, (len(z), 1)), np.repeat(z, len(ring))])
    top = face((-radius, -radius, height), (2 * radius, 0, 0), (0, 2 * radius, 0)).reshape(-1, 3)
    return np.concatenate([side, top[np.hypot(*top[:, :2].T) <= radius]]) + np.array([x, y, 0])


def cut(parts, camera=CAMERA, seed=0):
    """The objects' true and found labels."""
    points = np.concatenate(parts)
    noisy = points + np.random.default_rng(seed).normal(0, NOISE, points.shape)
    truth = np.repeat(np.arange(2, 2 + len(parts)), [len(part) for part in parts])
    return truth, convex_objects(noisy, camera, LEAST).labels


def assert_found(parts, least=0.85, **kwargs):
    truth, labels = cut(parts, **kwargs)
    assert len(np.unique(labels[labels > 0])) == len(parts)
    assert min(o.iou for o in overlaps(truth, labels)) > least


def under_and_over():
    """A smaller box on a larger one."""
    return [box(0, 0, 0.01, 0.2, 0.2, 0.08), box(0.05, 0.05, 0.09, 0.08, 0.08, 0.08)]


def test_one_object_is_one():
    assert_found([box(0, 0, 0.01, 0.1, 0.08, 0.12)], least=0.999)
    assert_found([cylinder(0, 0, 0.04, 0.12)], least=0.999)


def test_a_box_on_a_box_is_two():
    assert_found(under_and_over())


def test_a_stack_of_three():
    assert_found([*under_and_over(), box(0.07, 0.07, 0.17, 0.04, 0.04, 0.06)])


def test_a_low_box_that_touches_a_high_box():
    assert_found([box(0, 0, 0.01, 0.1, 0.1, 0.2), box(0.1, -0.02, 0.01, 0.12, 0.1, 0.06)])


def test_a_cylinder_on_a_box():
    on_top = cylinder(0.1, 0.1, 0.035, 0.1) + np.array([0, 0, 0.09])
    assert_found([box(0, 0, 0.01, 0.2, 0.2, 0.08), on_top])


def test_an_l_block_has_a_crease_and_is_cut_there():
    # Shape alone cannot tell an L-block from a box beside a box: this is the limit of the method. The crease is
    # long beside the flush side; of a block half as wide, some lattices of seeds find it and others do not.
    foot = box(0, 0, 0.01, 0.2, 0.2, 0.05)
    upright = box(0, 0.12, 0.06, 0.2, 0.08, 0.12)
    assert len(np.unique(cut([foot, upright])[1])) == 2


def test_the_cut_that_agrees_most_with_the_others_is_taken():
    two, three, one = (CutCloud(np.array(labels)) for labels in ([2, 2, 3, 3], [2, 2, 3, 4], [2, 2, 2, 2]))
    # Each point's best match: (1 + 1 + 1/2 + 1/2) / 4 both ways; (1/2 + 1/2 + 1/2 + 1/2) / 4 with one object.
    assert agreement(two.labels, three.labels) == agreement(three.labels, two.labels) == 0.75
    assert agreement(two.labels, one.labels) == 0.5
    assert most_agreed([one, three, two]) is two


def test_objects_apart_need_no_crease():
    assert_found([box(0, 0, 0.01, 0.1, 0.1, 0.1), box(0.15, 0, 0.01, 0.1, 0.1, 0.1)], least=0.999)


def test_without_a_camera_the_outer_side_is_guessed():
    assert_found(under_and_over(), camera=None)


def seen_at(parts, far, seed=0):
    """The scene moved `far` metres from the camera: fewer points, depth noise that grows with range squared, as a
    Kinect's: 1.6 mm at 1 m, and its steps of 3 mm."""
    points = np.concatenate(parts)[:: max(1, round(far**2))]
    aim = far * CAMERA / np.linalg.norm(CAMERA)
    sight = points - aim
    away = np.linalg.norm(sight, axis=1)
    noisy = away + 0.0016 * away**2 * np.random.default_rng(seed).normal(size=len(points))
    stepped = 1 / (np.round(1 / noisy / 0.003) * 0.003)
    return convex_objects(aim + sight * (stepped / away)[:, None], aim, LEAST).labels


@pytest.mark.parametrize("far", [1.0, 1.5, 2.0, 2.5])
def test_noise_at_range_does_not_cut_a_box_into_pieces(far):
    labels = seen_at([box(0, 0, 0.01, 0.2, 0.2, 0.15), box(0.5, 0, 0.01, 0.15, 0.15, 0.2)], far)
    assert len(np.unique(labels[labels > 0])) == 2
    assert np.mean(labels > 0) > 0.97


def test_labels_are_by_size_and_specks_are_noise():
    large, small = box(0, 0, 0.01, 0.2, 0.2, 0.08), box(0.4, 0, 0.01, 0.05, 0.05, 0.05)
    labels = convex_objects(np.concatenate([small, large, [[0.0, 0.5, 0.1]]]), CAMERA, LEAST).labels
    assert set(labels[: len(small)]) == {3}
    assert set(labels[len(small) : -1]) == {2}
    assert labels[-1] == 0


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4, 30])
def test_few_points_are_no_object(n):
    points = np.random.default_rng(n).uniform(0, 0.01, (n, 3))
    assert convex_objects(points, CAMERA, LEAST).labels.tolist() == [0] * n
    same = np.zeros((n, 3))
    assert convex_objects(same, None, LEAST).labels.tolist() == [0] * n


def test_a_large_box_alone_is_surer_than_a_small_box_on_another():
    points = np.concatenate([*under_and_over(), box(0.4, 0, 0.01, 0.2, 0.2, 0.1)])
    found = convex_objects(points, CAMERA, LEAST)
    assert set(found.confidence) == {2, 3, 4}
    alone, on_top = found.labels[-1], found.labels[len(under_and_over()[0]) + 10]
    assert 0 < found.confidence[on_top] < found.confidence[alone] <= 1
    assert found.confidence[alone] > 0.9


def test_an_empty_table_has_no_objects():
    table = face((-0.4, -0.4, 0), (0.8, 0, 0), (0, 0.8, 0)).reshape(-1, 3)
    labels = cut_cloud(table, None, SegmentationSettings(), CAMERA).labels
    assert set(labels) == {TABLE}


@pytest.mark.parametrize(("height", "objects"), [(0.013, 0), (0.03, 1)])
def test_a_thin_sheet_over_a_far_table_is_its_noise(height, objects):
    table = face((-0.4, -0.4, 0), (0.8, 0, 0), (0, 0.8, 0)).reshape(-1, 3)
    sheet = face((0, 0, height), (0.1, 0, 0), (0, 0.1, 0)).reshape(-1, 3)
    points = np.concatenate([table, sheet])
    far = 1.3 * CAMERA / np.linalg.norm(CAMERA)
    for camera, found in ((far, objects), (0.7 * far, 1), (None, 1)):
        labels = cut_cloud(points, None, SegmentationSettings(), camera).labels
        assert set(labels) - {0, TABLE} == set(range(2, 2 + found))


def test_the_same_cloud_gives_the_same_labels():
    parts = under_and_over()
    assert (cut(parts)[1] == cut(parts)[1]).all()


@pytest.mark.parametrize("seed", range(3))
def test_order_and_place_of_the_points_do_not_matter(seed):
    truth, labels = cut(under_and_over())
    rng = np.random.default_rng(seed)
    points = np.concatenate(under_and_over()) + np.random.default_rng(0).normal(0, NOISE, (len(truth), 3))
    order = rng.permutation(len(points))
    assert (convex_objects(points[order], CAMERA, LEAST).labels == labels[order]).mean() > 0.99
    turn = rng.uniform(0, 2 * np.pi)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    shift = rng.uniform(-1, 1, 3)
    # Cells lie elsewhere then, so a few points at creases change sides.
    moved = convex_objects(points @ rotation.T + shift, rotation @ CAMERA + shift, LEAST).labels
    assert min(o.iou for o in overlaps(truth, moved)) > 0.85
    assert len(np.unique(moved)) == 2


def test_a_large_cloud_has_larger_voxels():
    high = np.random.default_rng(0).uniform((0, 0, 0.3), (0.3, 0.3, 0.301), (40_000, 3))
    surface = surface_voxels(high, CAMERA, 0.005, 1000)
    assert surface.size == 0.01
    assert len(surface.points) <= 1000


@pytest.mark.slow
def test_hostile_points_give_labels_for_all():
    rng = np.random.default_rng(4)
    for _ in range(60):
        n = int(rng.integers(1, 3000))
        points = rng.normal(0, 10.0 ** rng.integers(-4, 3), (n, 3))
        if rng.random() < 0.5:
            points[:, int(rng.integers(3))] = rng.normal()
        if rng.random() < 0.3:
            points = points[rng.integers(0, n, n)]
        camera = None if rng.random() < 0.3 else points[0] if rng.random() < 0.5 else rng.normal(0, 1, 3)
        labels = convex_objects(points, camera, LEAST).labels
        found = np.unique(labels[labels > 0])
        assert labels.shape == (n,)
        assert found.tolist() == list(range(2, 2 + len(found)))


@pytest.mark.slow
@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
def test_real_scenes_are_cut_as_well_as_measured():
    objects = []
    folders = [Path(os.environ["LIFELORE_DATA"]) / name for name in ("osd", "osd_hard")]
    for path in sorted(path for folder in folders for path in folder.glob("*.pcd")):
        cloud = read_cloud(path)
        scene = to_scene(PointCloud(cloud.points, camera=cloud.camera))
        objects += overlaps(cloud.labels[cloud.measured], scene.labels)
    points, iou, right, wrong = np.array(objects).T
    # Weighted overlap, over- and under-segmentation (Richtsfeld et al. 2012), objects found. Over shifts of the
    # voxels: 0.955 to 0.97, 0.02 to 0.03, 0.01 to 0.05, and 0.97 to 0.99.
    assert (points * iou).sum() / points.sum() >= 0.94
    assert (points - right).sum() / points.sum() <= 0.04
    assert wrong.sum() / points.sum() <= 0.06
    assert (iou >= FOUND).mean() >= 0.96
