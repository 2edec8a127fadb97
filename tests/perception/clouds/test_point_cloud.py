"""What a `PointCloud` accepts, and what it says of itself."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.point_cloud import PointCloud, finite_rows

POINTS = np.array([[0.0, 1.0, 2.0], [np.nan, 0.0, 0.0], [0.0, np.inf, 0.0], [3.0, 4.0, 5.0]])


def test_a_point_is_measured_when_all_three_coordinates_are_finite() -> None:
    assert finite_rows(POINTS).tolist() == [True, False, False, True]
    assert PointCloud(POINTS).measured.tolist() == [True, False, False, True]


def test_only_keeps_what_belongs_together_and_the_rows() -> None:
    cloud = PointCloud(
        POINTS, np.array([0, 1, 2, 3]), np.arange(12, dtype=np.uint8).reshape(4, 3), (2, 2), np.ones(3)
    )
    part = cloud.only(np.array([3, 0]))
    assert part.labels.tolist() == [3, 0]
    assert part.colours.tolist() == [[9, 10, 11], [0, 1, 2]]
    assert part.grid == (2, 2)
    assert part.source_rows.tolist() == [3, 0]
    assert part.camera is cloud.camera
    loose = PointCloud(POINTS).only(np.array([True, False, True, True])).only(np.array([2, 0]))
    assert loose.source_rows.tolist() == [3, 0]
    assert PointCloud(POINTS, from_parts=True).only(np.array([0])).from_parts


def test_labels_of_nothing_but_zero_are_no_labels() -> None:
    assert not PointCloud(POINTS).is_labelled
    assert not PointCloud(POINTS, np.zeros(4, np.int64)).is_labelled
    assert PointCloud(POINTS, np.array([0, 0, 1, 0])).is_labelled


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"points": POINTS[:, :2]}, "points must be floats"),
        ({"points": np.ones((4, 3), int)}, "floats"),
        ({"labels": np.zeros(3, np.int64)}, "labels must be 4"),
        ({"labels": np.full(4, -1)}, "from 0"),
        ({"colours": np.zeros((4, 4), np.uint8)}, "colours must have shape"),
        ({"grid": (3, 2)}, "must hold the 4 points"),
        ({"source_rows": np.arange(3)}, "source_rows must be 4"),
        ({"grid": (3, 2), "source_rows": np.arange(3)}, "must be 4 numbers"),
        ({"grid": (3, 2), "source_rows": np.array([0, 1, 2, 6])}, "lie in 0 to 5"),
        ({"grid": (3, 2), "source_rows": np.array([0, 1, 2, -1])}, "lie in 0 to 5"),
        ({"camera": np.zeros(2)}, "camera must have shape"),
        ({"camera": np.array([0, np.nan, 0])}, "camera must be three finite numbers"),
        ({"camera": np.array([0, 0, -np.inf])}, "camera must be three finite numbers"),
    ],
)
def test_what_does_not_fit_is_refused(change: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        PointCloud(**{"points": POINTS, **change})
