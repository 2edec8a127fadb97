"""Raw frames: the whole picture, its noise by range, its truth, and the same frame for the same seed."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.tabletop.raw_room import FARTHEST, NEAREST, raw_room
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.table_frame import segmented_scene

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = [pytest.mark.sim, pytest.mark.slow]


@pytest.fixture(scope="module")
def shelf():
    return raw_room(5, 0, "shelf")


def test_a_frame_is_whole_and_raw(shelf):
    assert shelf.points.shape == shelf.colours.shape == (480 * 640, 3)
    seen = np.isfinite(shelf.points[:, 2])
    assert 0.5 < seen.mean() < 1
    assert (shelf.labels[~seen] == 0).all()
    depth = shelf.points[seen, 2]
    # The drift and the noise of the disparity pass the limits of the true depth by a few per cent.
    assert depth.min() > 0.9 * NEAREST
    assert depth.max() < 1.15 * FARTHEST
    # Depths are those of disparities in eighths of a pixel.
    eighths = 8 * 525 * 0.075 / depth
    np.testing.assert_allclose(eighths, eighths.round(), atol=1e-6)
    # Row by row through the pinhole: column 0 is on the left, row 0 at the top.
    grid = shelf.points.reshape(480, 640, 3)
    assert np.nanmax(grid[:, 0, 0]) < 0 < np.nanmin(grid[:, -1, 0])
    assert np.nanmax(grid[0, :, 1]) < 0 < np.nanmin(grid[-1, :, 1])


def test_the_truth_fits_the_points(shelf):
    heights = shelf.points @ shelf.plane[:3] + shelf.plane[3]
    table = heights[shelf.labels == 1]
    assert abs(np.median(table)) < 0.005
    assert np.percentile(np.abs(table), 95) < 0.03
    assert np.nanmedian(heights[shelf.labels >= 2]) > 0.01
    np.testing.assert_allclose(np.linalg.norm(shelf.up), 1)


def test_the_same_seed_gives_the_same_frame(shelf):
    again = raw_room(5, 0, "shelf")
    np.testing.assert_array_equal(again.points, shelf.points)
    np.testing.assert_array_equal(again.colours, shelf.colours)


def test_a_glass_table_has_no_plane():
    room = raw_room(5, 4, "glass table")
    assert room.plane is None
    assert not (room.labels == 1).any()


def test_an_unknown_kind_is_refused():
    with pytest.raises(InputError, match="kind must be one of plain"):
        raw_room(5, 0, "cellar")


@pytest.mark.parametrize(("number", "kind"), [(0, "plain"), (1, "against a wall"), (3, "furniture")])
def test_the_table_of_a_raw_room_is_found(number, kind):
    room = raw_room(5, number, kind)
    scene = segmented_scene(PointCloud(room.points, None, room.colours, (480, 640), np.zeros(3)))
    assert scene.table.plane.normal @ room.up > np.cos(np.radians(2))
    assert abs(scene.table.plane.offset - room.plane[3]) < 0.03
    assert 1 <= len(scene.cloud.objects) <= 12


def test_a_raw_frame_out_of_a_rosbag(shelf, tmp_path):
    pytest.importorskip("rosbags", reason="needs the extra ros")
    from lifelore.bridges.rosbag_cloud import read_bag_cloud

    cloud = read_bag_cloud(recorded(tmp_path / "room", shelf.points.astype(np.float32)))
    assert cloud.grid == (480, 640)
    np.testing.assert_array_equal(cloud.points, shelf.points.astype(np.float32))
    scene = segmented_scene(cloud, up=shelf.up)
    assert scene.table.plane.normal @ shelf.up > np.cos(np.radians(2))


def recorded(path, points):
    """A ROS 2 bag of one organised cloud."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    kind = "sensor_msgs/msg/PointCloud2"
    store = get_typestore(Stores.ROS2_HUMBLE)
    field, header = store.types["sensor_msgs/msg/PointField"], store.types["std_msgs/msg/Header"]
    stamp = store.types["builtin_interfaces/msg/Time"](sec=1, nanosec=0)
    message = store.types[kind](
        header=header(stamp=stamp, frame_id="camera"),
        height=480,
        width=640,
        fields=[field(name, 4 * k, 7, 1) for k, name in enumerate("xyz")],
        is_bigendian=False,
        point_step=12,
        row_step=12 * 640,
        data=np.ascontiguousarray(points).view(np.uint8).ravel(),
        is_dense=False,
    )
    with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/points", kind, typestore=store)
        writer.write(connection, 10**9, store.serialize_cdr(message, kind))
    return path
