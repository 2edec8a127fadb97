"""Pair features: worked by hand on blocks, the same for a turned scene, mirrored for a turned pair."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.contacts.interface import Interface, interfaces
from lifelore.perception.contacts.object_shape import shape_of
from lifelore.perception.pairs.pair_features import COLUMNS, TURNING_COLUMNS, VIEW_COLUMNS, pair_features


def stacked(box, camera=None) -> LabelledCloud:
    parts = [box((0, 0, 0), (0.1, 0.08, 0.05)), box((0.02, 0.02, 0.052), (0.06, 0.06, 0.1))]
    return LabelledCloud(np.vstack(parts), np.repeat([2, 3], [len(part) for part in parts]), None, camera)


def beside(box, camera) -> LabelledCloud:
    """3 stands behind and to the right of 2 for a camera that looks along +y."""
    parts = [box((0, 0, 0), (0.05, 0.05, 0.05)), box((0.06, 0.04, 0), (0.11, 0.09, 0.05))]
    return LabelledCloud(np.vstack(parts), np.repeat([2, 3], [len(part) for part in parts]), None, camera)


def row(features, pair, *names) -> list[float]:
    at = [tuple(p) for p in features.pairs.tolist()].index(pair)
    return features.columns(names)[at].tolist()


def test_a_block_on_a_block_reads_as_built(box):
    features = pair_features(stacked(box))
    assert features.names == COLUMNS
    assert features.pairs.tolist() == [[2, 3], [3, 2]]
    up = row(
        features, (3, 2), "rise_0", "normal_up_0", "below_a_0", "above_b_0", "foot_a", "top_b", "a_over_b", "gap"
    )
    np.testing.assert_allclose(up, [0.002, 1, 0, 0, 0.052, 0.05, 1, 0.0025], atol=0.003)
    assert row(features, (3, 2), "b_over_a")[0] < 0.5


def test_the_turned_pair_swaps_the_sides_and_turns_what_points(box):
    features = pair_features(stacked(box))
    for name in ("below", "above"):
        for scale in "01":
            assert row(features, (2, 3), f"{name}_a_{scale}") == row(features, (3, 2), f"{name}_b_{scale}")
    for name in ("foot", "top", "height", "width", "overlap_share"):
        assert row(features, (2, 3), f"{name}_a") == row(features, (3, 2), f"{name}_b")
    for name in ("rise_0", "normal_up_1", "elevation_0", "centre_rise"):
        assert row(features, (2, 3), name)[0] == -row(features, (3, 2), name)[0]
    for name in ("gap", "horizontal_0", "distance_1", "centre_horizontal"):
        assert row(features, (2, 3), name) == row(features, (3, 2), name)


def test_a_scene_turned_about_the_vertical_keeps_its_columns(box):
    cloud = stacked(box)
    quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    turned = LabelledCloud(cloud.points @ quarter.T, cloud.labels)
    first, second = (pair_features(one).columns(TURNING_COLUMNS) for one in (cloud, turned))
    np.testing.assert_allclose(first, second, atol=0.004)


def test_behind_and_right_are_the_cameras(box):
    features = pair_features(beside(box, np.array([0.05, -1.0, 0.5])))
    behind, right = row(features, (3, 2), "behind", "right")
    np.testing.assert_allclose([behind, right], [0.04, 0.06], atol=0.005)
    assert row(features, (2, 3), "behind", "right") == [-behind, -right]
    from_the_other_side = pair_features(beside(box, np.array([0.05, 1.0, 0.5])))
    np.testing.assert_allclose(row(from_the_other_side, (3, 2), "behind", "right"), [-behind, -right], atol=0.01)
    assert not pair_features(beside(box, None)).columns(VIEW_COLUMNS).any()


def test_known_interfaces_are_used_and_an_empty_scene_has_no_rows(box):
    cloud = stacked(box)
    np.testing.assert_array_equal(pair_features(cloud, interfaces(cloud)).matrix, pair_features(cloud).matrix)
    empty = pair_features(LabelledCloud(np.empty((0, 3)), np.empty(0, np.int64)))
    assert empty.matrix.shape == (0, len(COLUMNS))


def test_a_table_row_is_finite_with_its_one_scale(box):
    parts = [box((0, 0, 0.001), (0.05, 0.05, 0.05)), box((-0.1, -0.1, 0), (0.2, 0.2, 0))]
    cloud = LabelledCloud(np.vstack(parts), np.repeat([2, TABLE], [len(part) for part in parts]))
    features = pair_features(cloud)
    assert np.isfinite(features.matrix).all()
    assert row(features, (2, TABLE), "rise_0") == row(features, (2, TABLE), "rise_1")


def test_unknown_columns_and_bare_interfaces_are_refused(box):
    with pytest.raises(InputError, match="colour"):
        pair_features(stacked(box)).columns(["gap", "colour"])
    bare = Interface(2, 3, 0.0, (), (), np.empty((0, 2), np.int64))
    with pytest.raises(InputError, match="no points"):
        pair_features(stacked(box), [bare])


def test_a_shape_lets_stray_points_stick_out():
    points = np.random.default_rng(0).random((2000, 3)) * [0.1, 0.2, 0.3]
    shape = shape_of(np.vstack([points, [[0.05, 0.1, 5.0], [9.0, 0.1, 0.1]]]))
    np.testing.assert_allclose([shape.foot, shape.top, shape.width], [0, 0.3, 0.21], atol=0.015)
    np.testing.assert_allclose(shape.centre, [0.05, 0.1, 0.15], atol=0.01)
    assert len(shape.sample) <= 300
    assert shape.over(shape).mean() > 0.9
    assert shape_of(np.zeros((1, 3))).height == 1e-3
