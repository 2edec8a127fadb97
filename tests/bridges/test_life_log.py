"""Logs of a life are read back: MCAP as a bag of ROS 2, .rrd by Rerun itself."""

import numpy as np
import pytest

from lifelore.bridges.viewer_log import write_life_log
from lifelore.core.errors import InputError
from lifelore.domains.buildings.logged_life import LoggedLife
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap

MAP = OccupancyMap(np.array([[FREE, OCCUPIED], [UNKNOWN, FREE]], np.uint8), 0.5, (1.0, 2.0, np.pi / 2))
COSTS = np.array([[30, 255], [255, 0]], np.uint8)
WAYS = [
    ("to lab", 20.5, np.array([[1.0, 2.0], [1.0, 4.0]])),
    ("to dock", 10.25, np.array([[0.0, 0.0], [3.0, 0.0]])),
]
EVENTS = [("reached", 30.0, (1.0, 4.0)), ("refused east", 15.0, (1.0, 3.0))]


def test_an_mcap_file_holds_map_costs_ways_and_events(tmp_path):
    highlevel = pytest.importorskip("rosbags.highlevel", reason="needs the extra ros")
    path = tmp_path / "life.mcap"
    path.write_text("an older file")
    write_life_log(str(path), LoggedLife(MAP, COSTS, WAYS, EVENTS))
    with highlevel.AnyReader([path]) as reader:
        found = [(c.topic, time, reader.deserialize(data, c.msgtype)) for c, time, data in reader.messages()]
    assert [(topic, time / 1e9) for topic, time, _ in found] == [
        ("/map", 10.25), ("/lifelore/costs", 10.25), ("/lifelore/way", 10.25), ("/lifelore/events", 15.0),
        ("/lifelore/way", 20.5), ("/lifelore/events", 30.0),
    ]  # fmt: skip
    seen, costs, to_dock, refused, to_lab, reached = [message for _, _, message in found]
    assert seen.data.tolist() == [-1, 0, 0, 100]  # the lowest row comes first
    assert costs.data.tolist() == [-1, 0, 30, -1]
    assert (seen.info.width, seen.info.height, seen.info.resolution) == (2, 2, 0.5)
    origin = seen.info.origin
    assert (origin.position.x, origin.position.y) == (1.0, 2.0)
    assert 2 * np.arctan2(origin.orientation.z, origin.orientation.w) == pytest.approx(np.pi / 2)
    assert [(pose.pose.position.x, pose.pose.position.y) for pose in to_dock.poses] == [(0, 0), (3, 0)]
    turn = to_lab.poses[-1].pose.orientation
    assert 2 * np.arctan2(turn.z, turn.w) == pytest.approx(np.pi / 2)
    assert [(one.ns, one.text) for one in refused.markers] == [("events", ""), ("names", "refused east")]
    assert refused.markers[0].color.r > refused.markers[0].color.g
    assert reached.markers[0].color.g > reached.markers[0].color.r
    for message in (seen, costs, to_dock, refused.markers[1]):
        assert message.header.frame_id == "map"
    assert (to_lab.header.stamp.sec, to_lab.header.stamp.nanosec) == (20, 500_000_000)


def test_an_rrd_file_holds_the_same(tmp_path):
    chunk = pytest.importorskip("rerun.chunk", reason="needs the extra view")
    path = tmp_path / "life.rrd"
    write_life_log(str(path), LoggedLife(MAP, COSTS, WAYS, EVENTS))
    found: dict = {}
    for part in chunk.RrdReader(str(path)).stream():
        batch = part.to_record_batch()
        for name in batch.schema.names:
            column = batch.column(name)
            values = column.cast("int64") if str(column.type).startswith("timestamp") else column
            found.setdefault((part.entity_path, name), []).extend(values.to_pylist())
    # The occupied pixel lies in the second column and row; the map is turned a quarter to the left.
    assert found["/map", "Points3D:positions"][0] == [pytest.approx([1.0 - 0.75, 2.0 + 0.75, 0.0])]
    assert found["/costs", "Points3D:positions"][0] == [pytest.approx([1.0 - 0.75, 2.0 + 0.25, 0.0])]
    assert [one[0] for one in found["/way", "LineStrips3D:labels"]] == ["to dock", "to lab"]
    assert [len(one[0]) for one in found["/way", "LineStrips3D:strips"]] == [2, 2]
    assert [one[0] for one in found["/events", "Points3D:labels"]] == ["refused east", "reached"]
    assert [time / 1e9 for time in found["/events", "clock"]] == [15.0, 30.0]


def test_a_life_without_ways_is_its_map(tmp_path):
    pytest.importorskip("rosbags", reason="needs the extra ros")
    write_life_log(str(tmp_path / "life.mcap"), LoggedLife(MAP, COSTS, [], []))
    assert (tmp_path / "life.mcap").stat().st_size > 0


def test_another_ending_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"ends with \.mcap or \.rrd"):
        write_life_log(str(tmp_path / "life.bag"), LoggedLife(MAP, COSTS, [], []))
