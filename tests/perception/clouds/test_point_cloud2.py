"""PointCloud2 messages of any maker: padding, byte order, and sizes that lie."""

from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.point_cloud2 import cloud_from_message


def message(order="<", **changes):
    """Two rows of two points of 20 bytes, each row padded by 4 bytes."""
    layout = np.dtype(
        [("x", order + "f4"), ("y", order + "f4"), ("z", order + "f4"), ("gap", "V4"), ("rgb", order + "u4")]
    )
    points = np.zeros((2, 2), layout)
    points["x"], points["y"], points["z"] = [[0, 1], [2, 3]], 0.5, [[1, 2], [np.nan, 4]]
    points["rgb"] = 0x010203
    names = {"x": (0, 7), "y": (4, 7), "z": (8, 7), "rgb": (16, 6)}
    fields = [SimpleNamespace(name=n, offset=at, datatype=code, count=1) for n, (at, code) in names.items()]
    data = b"".join(row.tobytes() + bytes(4) for row in points)
    values = {"height": 2, "width": 2, "fields": fields, "is_bigendian": order == ">", "point_step": 20}
    return SimpleNamespace(**{**values, "row_step": 44, "data": data, **changes})


@pytest.mark.parametrize("order", ["<", ">"])
def test_points_colours_and_shape(order):
    cloud = cloud_from_message(message(order))
    assert cloud.points[[0, 1, 3]].tolist() == [[0, 0.5, 1], [1, 0.5, 2], [3, 0.5, 4]]
    assert cloud.measured.tolist() == [True, True, False, True]
    assert cloud.colours.tolist() == [[1, 2, 3]] * 4
    assert cloud.grid == (2, 2)
    assert cloud.camera.tolist() == [0, 0, 0]


def test_the_header_names_the_frame_and_the_time_in_ros_2_and_ros_1():
    assert cloud_from_message(message()).frame == (None, None)
    for stamp in (SimpleNamespace(sec=7, nanosec=250_000_000), SimpleNamespace(secs=7, nsecs=250_000_000)):
        header = SimpleNamespace(frame_id="camera_optical", stamp=stamp)
        assert cloud_from_message(message(header=header)).frame == ("camera_optical", 7.25)


def test_the_last_row_may_come_without_its_padding():
    assert len(cloud_from_message(message(data=message().data[:-4])).points) == 4


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"width": 0}, "must hold 1 to"),
        ({"width": 10**9}, "must hold 1 to"),
        ({"row_step": 39}, "promises 2 rows"),
        ({"data": b""}, "promises 2 rows"),
        ({"point_step": 16, "row_step": 32}, "field 'rgb' .* does not fit 16 bytes"),
        ({"fields": []}, "has no field x y z"),
    ],
)
def test_a_message_that_lies_is_refused(changes, said):
    with pytest.raises(InputError, match=said):
        cloud_from_message(message(**changes))
