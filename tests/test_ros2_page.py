"""The page on ROS 2 and its node: message fields fit the definitions of ROS 2 Humble, and the node goes its round.

rclpy cannot be installed from a package index, so the node runs here with a stand-in for rclpy. Its messages are
those of the type store of rosbags, which has the definitions of ROS 2 Humble: a field that does not exist fails.
"""

import ast
import importlib
import json
import re
import shlex
import shutil
import subprocess
import sys
import threading
import time
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

pytest.importorskip("rosbags", reason="needs the extra ros")

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from lifelore.agent.live.buildings.recognition import recognised_place
from lifelore.agent.travel import Travel
from lifelore.agent.way import path_message
from lifelore.bridges.mcap_file import message_of
from lifelore.bridges.scene_mcap import DEFINITIONS
from lifelore.domains.buildings.occupancy_map import read_occupancy_map, write_occupancy_map
from lifelore.domains.worlds import WorldSettings, map_from_settings, world_from_settings
from lifelore.memory import open_memory
from lifelore.perception.clouds.cloud_file import read_cloud
from tests.page_block import run_block

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "examples" / "ros2" / "lifelore_node"
PAGE = (ROOT / "docs" / "ros2.md").read_text(encoding="utf-8")
STORE = get_typestore(Stores.ROS2_HUMBLE)
for definition, text in DEFINITIONS.items():
    STORE.register(get_types_from_msg(text, definition))
MAP = ROOT / "examples" / "data" / "office.yaml"
MASKS = {"keepout_mask", "cost_mask", "speed_mask"}
PROGRAM = [sys.executable, "-m", "lifelore.app.command_line"]


@pytest.fixture(autouse=True)
def import_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(PACKAGE))


@pytest.fixture
def conversions() -> Any:
    return importlib.import_module("lifelore_node.conversions")


@pytest.fixture(scope="module")
def exports(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the first command of the page exports, after three tasks instead of five."""
    folder = tmp_path_factory.mktemp("round")
    (folder / "examples").symlink_to(ROOT / "examples")
    (line,) = re.findall(r"^lifelore (live .*)$", PAGE, flags=re.M)
    shorter = line.replace("--tasks 5", "--tasks 3")
    assert shorter != line
    run_block("sh", f"lifelore {shorter} --memory m.db", folder)
    return folder / "exports"


def message(name: str, fields: dict[str, Any]) -> Any:
    """A message of ROS 2 Humble with these fields, zero elsewhere; a field that does not exist fails."""
    return message_of(STORE, name, fields)


def sent(name: str, fields: dict[str, Any]) -> Any:
    """The message as it arrives, after it was serialised as ROS 2 does."""
    return STORE.deserialize_cdr(STORE.serialize_cdr(message(name, fields), name), name)


def cloud_message(points: np.ndarray, padding: int = 4, big: bool = False) -> Any:
    """A PointCloud2 of two rows with unused bytes after each point and each row."""
    order = ">" if big else "<"
    step = 16 + padding
    layout = np.dtype(
        {"names": ["x", "y", "z"], "formats": [order + "f4"] * 3, "offsets": [0, 4, 8], "itemsize": step}
    )
    rows = np.zeros((2, len(points) // 2), layout)
    for k, name in enumerate("xyz"):
        rows[name] = points[:, k].reshape(2, -1)
    data = [np.concatenate([np.frombuffer(row.tobytes(), np.uint8), np.full(8, 255, np.uint8)]) for row in rows]
    fields = [{"name": name, "offset": 4 * k, "datatype": 7, "count": 1} for k, name in enumerate("xyz")]
    return sent(
        "sensor_msgs/msg/PointCloud2",
        {
            "header": {"frame_id": "eye", "stamp": {"sec": 3, "nanosec": 4}},
            "height": 2, "width": rows.shape[1], "fields": fields, "is_bigendian": big, "point_step": step,
            "row_step": rows.shape[1] * step + 8, "data": np.concatenate(data).tolist(), "is_dense": False,
        },
    )  # fmt: skip


def test_the_commands_on_bags_run_as_printed(tmp_path):
    """The bag of a night teaches, closes the place of three bumps, and is undone."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    (block,) = re.findall(r"^## Bags of the robot\n\n```sh\n(.*?)^```", PAGE, flags=re.M | re.S)
    said = [run_block("sh", line, tmp_path) for line in block.splitlines()]
    assert "dry run: nothing is stored" in said[0]
    for text in said[:2]:
        assert "10 of 10 runs are new; 7 reached their goal" in text
        assert "3 bumps where the map is free" in text
    assert "10 runs of examples/data/night.mcap forgotten" in said[2]
    keepout = read_occupancy_map(tmp_path / "masks" / "keepout.yaml")
    assert keepout.state.shape == read_occupancy_map(ROOT / "examples" / "data" / "office.yaml").state.shape


# ---- conversions ---------------------------------------------------------------------------------------------


def test_a_mask_becomes_a_grid_with_the_lowest_row_first(conversions, tmp_path):
    grey = np.array([[0, 50, 100], [101, 255, 7]], np.uint8)
    write_occupancy_map(tmp_path / "mask.yaml", grey, 0.1, (1.0, 2.0, 0.5), mode="raw")
    grid = sent("nav_msgs/msg/OccupancyGrid", conversions.occupancy_grid(tmp_path / "mask.yaml"))
    assert (grid.info.width, grid.info.height) == (3, 2)
    assert grid.info.resolution == pytest.approx(0.1)
    assert grid.data.tolist() == [-1, -1, 7, 0, 50, 100]
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == (1.0, 2.0)
    turn = grid.info.origin.orientation
    assert 2 * np.arctan2(turn.z, turn.w) == pytest.approx(0.5)
    write_occupancy_map(tmp_path / "map.yaml", grey, 0.1)
    with pytest.raises(ValueError, match="must have mode raw, got trinary"):
        conversions.occupancy_grid(tmp_path / "map.yaml")


def test_a_way_becomes_a_path_in_the_frame_of_the_node(conversions):
    document = path_message(np.array([[1.0, 2.0, 0.5], [2.0, 3.0, -0.5]])) | {"length": 1.4, "places": 3}
    stamp = {"sec": 7, "nanosec": 8}
    path = sent("nav_msgs/msg/Path", conversions.way_fields(document, "floor", stamp))
    for header in (path.header, path.poses[1].header):
        assert (header.frame_id, header.stamp.sec, header.stamp.nanosec) == ("floor", 7, 8)
    pose = path.poses[1].pose
    assert (pose.position.x, pose.position.y) == (2.0, 3.0)
    assert 2 * np.arctan2(pose.orientation.z, pose.orientation.w) == pytest.approx(-0.5)


def test_a_way_is_asked_for_by_two_places(conversions):
    assert conversions.way_ends('{"from": "dock", "to": "-1.5,2"}') == ("dock", "-1.5,2")
    for wrong in ("dock lab", '{"from": "dock"}', "[1, 2]", ""):
        with pytest.raises(ValueError, match="a way is asked for by"):
            conversions.way_ends(wrong)


def program(folder: Path, text: str) -> str:
    """A program that runs these lines of a shell."""
    path = folder / "program"
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return str(path)


def test_what_a_command_prints_is_its_answer(conversions, tmp_path):
    echo = program(tmp_path, """printf '{"words": "%s"}' "$*" """)
    assert conversions.answer_of(echo, "way", tmp_path) == {"words": f"way {tmp_path} --json"}
    refusing = program(tmp_path, "echo 'lifelore: no such place' >&2; exit 2")
    with pytest.raises(ValueError, match=r"^lifelore: no such place$"):
        conversions.answer_of(refusing, "way")
    with pytest.raises(ValueError, match=r"program way --json took longer than 0.1 s"):
        conversions.answer_of(program(tmp_path, "exec sleep 5"), "way", seconds=0.1)
    with pytest.raises(OSError, match="nowhere"):
        conversions.answer_of("/nowhere/lifelore", "way")


@pytest.mark.parametrize("big", [False, True])
def test_points_of_a_padded_cloud(conversions, big):
    points = np.arange(30, dtype=np.float32).reshape(10, 3)
    points[3, 1] = np.nan
    found = conversions.cloud_points(cloud_message(points, big=big))
    assert found.tolist() == np.delete(points, 3, axis=0).tolist()


def test_a_cloud_without_z_is_refused(conversions):
    cloud = cloud_message(np.zeros((4, 3), np.float32))
    cloud.fields.pop()
    with pytest.raises(ValueError, match="z is missing"):
        conversions.cloud_points(cloud)


# ---- the round -----------------------------------------------------------------------------------------------


@pytest.fixture
def memory(exports: Path, tmp_path: Path) -> Path:
    """A copy of the memory of the life that exported."""
    return Path(shutil.copy(exports.parent / "m.db", tmp_path))


@pytest.fixture
def service(memory: Path) -> Iterator[str]:
    pytest.importorskip("fastapi", reason="needs the extra web")
    command = [*PROGRAM, "serve", "--json", "--port", "0", "--memory", str(memory)]
    served = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    with served:
        yield json.loads(served.stdout.readline())["url"]
        served.terminate()


class StandIn:
    """What the node uses of rclpy: parameters, publishers, subscriptions, services, clock and log."""

    parameters: dict[str, Any] = {}  # noqa: RUF012

    def __init__(self, name: str) -> None:
        self.name, self.log = name, []
        self.published: list[tuple[str, Any]] = []
        self.subscribed: dict[str, Any] = {}
        self.services: dict[str, Any] = {}
        self.arrived = threading.Event()

    def declare_parameter(self, name: str, default: Any) -> Any:
        return types.SimpleNamespace(value=self.parameters.get(name, default))

    def create_publisher(self, kind: Any, topic: str, quality: Any) -> Any:
        def publish(message: Any) -> None:
            assert message.__msgtype__ == kind().__msgtype__
            self.published.append((topic, message))
            if topic in ("lifelore/relations", "lifelore/way"):
                self.arrived.set()

        return types.SimpleNamespace(publish=publish)

    def create_subscription(self, kind: Any, topic: str, take: Any, quality: Any) -> None:
        self.subscribed[topic] = take

    def create_service(self, kind: Any, name: str, answer: Any) -> None:
        self.services[name] = answer

    def get_clock(self) -> Any:
        stamp = message("builtin_interfaces/msg/Time", {"sec": 7})
        return types.SimpleNamespace(now=lambda: types.SimpleNamespace(to_msg=lambda: stamp))

    def get_logger(self) -> Any:
        def error(text: str) -> None:
            self.log.append(text)
            self.arrived.set()

        return types.SimpleNamespace(warning=self.log.append, error=error)


def set_fields(target: Any, fields: dict[str, Any]) -> None:
    """As `set_message_fields` of rosidl_runtime_py: a field that does not exist fails."""
    filled = message(target.__msgtype__, fields)
    for name in fields:
        setattr(target, name, getattr(filled, name))


def module(name: str, **content: Any) -> types.ModuleType:
    made = types.ModuleType(name)
    vars(made).update(content)
    return made


@pytest.fixture
def node_module(monkeypatch: pytest.MonkeyPatch) -> Any:
    def kind(name: str) -> Any:
        return lambda: message(name, {})

    quality = types.SimpleNamespace(TRANSIENT_LOCAL=1)
    stand_ins = {
        "rclpy": module("rclpy"),
        "rclpy.node": module("rclpy.node", Node=StandIn),
        "rclpy.qos": module("rclpy.qos", DurabilityPolicy=quality, QoSProfile=dict, qos_profile_sensor_data={}),
        "rosidl_runtime_py": module("rosidl_runtime_py"),
        "rosidl_runtime_py.set_message": module("rosidl_runtime_py.set_message", set_message_fields=set_fields),
    }
    for name, kinds in {
        "nav_msgs": ["OccupancyGrid", "Path"],
        "sensor_msgs": ["PointCloud2"],
        "std_msgs": ["String"],
        "vision_msgs": ["Detection3DArray"],
        "lifelore_msgs": ["SpatialRelationArray"],
    }.items():
        stand_ins[name] = module(name)
        stand_ins[f"{name}.msg"] = module(f"{name}.msg", **{one: kind(f"{name}/msg/{one}") for one in kinds})
    stand_ins |= {"std_srvs": module("std_srvs"), "std_srvs.srv": module("std_srvs.srv", Trigger=object)}
    for name, made in stand_ins.items():
        monkeypatch.setitem(sys.modules, name, made)
    monkeypatch.delitem(sys.modules, "lifelore_node.node", raising=False)
    return importlib.import_module("lifelore_node.node")


@pytest.mark.slow
def test_the_node_publishes_exports_and_answers_a_cloud_with_relations(node_module, exports, service, monkeypatch):
    monkeypatch.setattr(StandIn, "parameters", {"exports": str(exports), "url": service, "frame": "floor"})
    node = node_module.LifeloreNode()
    assert not node.log
    topics = dict(node.published)
    assert set(topics) == MASKS
    for published in topics.values():
        assert (published.header.frame_id, published.header.stamp.sec) == ("floor", 7)
    cloud = read_cloud(ROOT / "examples" / "data" / "table.pcd")
    points = np.asarray(cloud.points, np.float32)
    node.subscribed["points"](cloud_message(points[: len(points) // 2 * 2]))
    assert node.arrived.wait(60)
    answers = {topic: answer for topic, answer in node.published if topic not in topics}
    assert set(answers) == {"lifelore/facts", "lifelore/detections", "lifelore/relations"}
    assert any(fact.startswith("on(") for fact in json.loads(answers["lifelore/facts"].data)["facts"])
    relations = answers["lifelore/relations"].relations
    assert "on" in {relation.relation for relation in relations}
    detections = answers["lifelore/detections"]
    assert {relation.a for relation in relations} <= {one.id for one in detections.detections}
    for answer in (detections, answers["lifelore/relations"], detections.detections[0]):
        header = answer.header
        assert (header.frame_id, header.stamp.sec, header.stamp.nanosec) == ("eye", 3, 4)
    # Each box holds points of the cloud that was sent, in that cloud's frame.
    for one in detections.detections:
        turn, at = one.bbox.center.orientation, one.bbox.center.position
        axes = Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).as_matrix()
        within = np.abs((points - [at.x, at.y, at.z]) @ axes)
        size = one.bbox.size
        assert (within <= np.array([size.x, size.y, size.z]) / 2 + 1e-4).all(axis=1).sum() > 20


@pytest.mark.slow
def test_a_cloud_that_the_service_refuses_is_logged_in_its_words(node_module, service, monkeypatch, tmp_path):
    monkeypatch.setattr(StandIn, "parameters", {"exports": str(tmp_path), "url": service})
    node = node_module.LifeloreNode()
    assert [line.endswith("stays silent") for line in node.log] == [True] * len(MASKS)
    node.arrived.clear()
    node.subscribed["points"](cloud_message(np.zeros((4, 3), np.float32)))
    assert node.arrived.wait(60)
    assert node.log[-1].startswith("no table was found in the cloud")
    assert "Traceback" not in node.log[-1]


def lifelore(folder: Path) -> str:
    return program(folder, f'exec {shlex.join(PROGRAM)} "$@"')


@pytest.mark.slow
def test_the_masks_follow_memory(node_module, service, memory, monkeypatch, tmp_path):
    chosen = {"exports": str(tmp_path / "out"), "url": service, "map": str(MAP), "program": lifelore(tmp_path)}
    monkeypatch.setattr(StandIn, "parameters", chosen | {"memory": str(memory), "period": 0.2})
    node = node_module.LifeloreNode()
    before = masks_published(node, 1)
    settings = WorldSettings("building", str(MAP))
    given = map_from_settings(settings)
    with open_memory(memory) as opened:
        place = recognised_place(settings, world_from_settings(settings, given), given, opened)
        travel, (state, action) = Travel(place.world, place.grid), np.argwhere(place.world.neighbour >= 0)[400]
        travel.observe([state] * 9, [action] * 9, 1.7e9 + 60 * np.arange(9), [np.nan] * 9)
        opened.contribute("other", travel.news(), process="p", seq=0, task={})
    after = masks_published(node, 2)
    assert (np.array(after["cost_mask"].data) > np.array(before["cost_mask"].data)).any()
    assert (np.array(after["keepout_mask"].data) > np.array(before["keepout_mask"].data)).any()
    assert all(line.endswith("stays silent") for line in node.log)


def test_a_service_that_is_away_is_logged_once(node_module, monkeypatch, tmp_path):
    chosen = {"exports": str(tmp_path), "map": str(MAP), "url": "http://127.0.0.1:9", "period": 0.01}
    monkeypatch.setattr(StandIn, "parameters", chosen)
    node = node_module.LifeloreNode()
    assert node.arrived.wait(60)
    time.sleep(0.2)
    (line,) = [line for line in node.log if not line.endswith("stays silent")]
    assert line.startswith("the masks do not follow memory: http://127.0.0.1:9 does not answer")


def masks_published(node: StandIn, times: int) -> dict[str, Any]:
    """The newest masks, after each was published so many times."""
    for _ in range(600):
        topics = [topic for topic, _ in list(node.published)]
        if all(topics.count(mask) == times for mask in MASKS):
            return dict(node.published)
        time.sleep(0.1)
    raise AssertionError(node.log)


@pytest.mark.slow
def test_a_way_is_answered_with_a_path(node_module, exports, memory, monkeypatch, tmp_path):
    chosen = {
        "exports": str(exports),
        "memory": str(memory),
        "program": lifelore(tmp_path),
        "url": "http://127.0.0.1:9",
    }
    monkeypatch.setattr(StandIn, "parameters", chosen)
    node = node_module.LifeloreNode()
    node._map = str(MAP)  # without the thread that follows memory
    graph = json.loads((exports / "route_graph.geojson").read_text(encoding="utf-8"))
    start, goal = [one["geometry"]["coordinates"] for one in graph["features"][:2]]
    ends = {"from": f"{start[0]},{start[1]}", "to": f"{goal[0]},{goal[1]}"}
    node.subscribed["lifelore/way_request"](message("std_msgs/msg/String", {"data": json.dumps(ends)}))
    assert node.arrived.wait(60)
    (path,) = [answer for topic, answer in node.published if topic == "lifelore/way"]
    points = [[pose.pose.position.x, pose.pose.position.y] for pose in path.poses]
    assert points[0] == pytest.approx(start)
    assert points[-1] == pytest.approx(goal)
    assert np.hypot(*np.diff(points, axis=0).T).max() <= 0.051
    node.arrived.clear()
    node.subscribed["lifelore/way_request"](message("std_msgs/msg/String", {"data": "lab"}))
    assert node.arrived.wait(60)
    assert node.log[-1].startswith("a way is asked for by")


def test_recognition_is_a_service(node_module, monkeypatch, tmp_path):
    echo = program(tmp_path, """printf '{"words": "%s"}' "$*" """)
    monkeypatch.setattr(StandIn, "parameters", {"exports": str(tmp_path), "program": echo, "memory": "m.db"})
    node = node_module.LifeloreNode()
    node._map = "new.yaml"
    answer = node.services["lifelore/recognise"](None, types.SimpleNamespace())
    assert answer.success
    assert json.loads(answer.message) == {"words": "recognise new.yaml --memory m.db --json"}
    program(tmp_path, "echo 'lifelore: no such building' >&2; exit 2")
    answer = node.services["lifelore/recognise"](None, types.SimpleNamespace())
    assert (answer.success, answer.message) == (False, "lifelore: no such building")


# ---- the page ------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_its_python_runs_in_the_checkout(exports):
    _, code = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.S | re.M)
    said = run_block("python", code, exports.parent)
    assert re.search(r"680 × 480 pixels, \d+ of them kept out", said)


def test_its_topics_and_parameters_are_those_of_the_node():
    source = (PACKAGE / "lifelore_node" / "node.py").read_text(encoding="utf-8")
    ast.parse(source)
    answers = ("lifelore/facts", "lifelore/detections", "lifelore/relations")
    for topic in (*MASKS, "lifelore/way", "lifelore/way_request", "lifelore/recognise", *answers):
        assert f'"{topic}"' in source
        assert f"/{topic}`" in PAGE
    for parameter in re.findall(r'declare_parameter\("(\w+)"', source):
        assert f"`{parameter}`" in PAGE


def test_the_page_and_the_package_say_that_no_robot_has_run_it():
    assert "tested on a robot" in PAGE.split("## ")[0]
    for package in (PACKAGE, PACKAGE.parent / "lifelore_msgs"):
        assert "Untested on a robot" in (package / "package.xml").read_text(encoding="utf-8")
