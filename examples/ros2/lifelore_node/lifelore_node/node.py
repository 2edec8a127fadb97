"""The node: masks that follow memory, ways and recognition on request, objects and relations of each cloud.

Untested on a robot. All conversions are in `conversions` and `detection3d`, which need no ROS.
"""

import json
import os
import queue
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import rclpy
from lifelore_msgs.msg import SpatialRelationArray
from nav_msgs.msg import OccupancyGrid
from nav_msgs.msg import Path as PathMessage
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rosidl_runtime_py.set_message import set_message_fields
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String
from std_srvs.srv import Trigger
from vision_msgs.msg import Detection3DArray

from lifelore_node.conversions import (
    answer_of,
    cloud_points,
    facts_text,
    header_fields,
    memory_revision,
    occupancy_grid,
    perceived,
    way_ends,
    way_fields,
)
from lifelore_node.detection3d import detection_array, relation_array

MASKS = {"keepout_mask": "keepout.yaml", "cost_mask": "costs.yaml", "speed_mask": "speed.yaml"}
"""Topics of the masks, as in docs/nav2.md, and their files."""


class LifeloreNode(Node):
    """Asks the service for scenes and for changes of memory, and the program for masks, ways and recognition."""

    def __init__(self) -> None:
        super().__init__("lifelore_node")
        self._exports = Path(self.declare_parameter("exports", "exports").value)
        self._url = self.declare_parameter("url", "http://127.0.0.1:8321").value
        self._frame = self.declare_parameter("frame", "map").value
        self._map = self.declare_parameter("map", "").value
        self._program = self.declare_parameter("program", "lifelore").value
        memory = self.declare_parameter("memory", "").value
        self._memory = ["--memory", memory] if memory else []
        self._period = self.declare_parameter("period", 5.0).value
        # A parameter would show the token to every node.
        self._token = os.environ.get("LIFELORE_TOKEN", "")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._masks = {topic: self.create_publisher(OccupancyGrid, topic, latched) for topic in MASKS}
        self._facts = self.create_publisher(String, "lifelore/facts", 10)
        self._detections = self.create_publisher(Detection3DArray, "lifelore/detections", 10)
        self._relations = self.create_publisher(SpatialRelationArray, "lifelore/relations", 10)
        self._way = self.create_publisher(PathMessage, "lifelore/way", 10)
        self._clouds: queue.Queue[PointCloud2] = queue.Queue(maxsize=1)
        self.create_subscription(PointCloud2, "points", self._take_cloud, qos_profile_sensor_data)
        self.create_subscription(String, "lifelore/way_request", self._answer_way, 10)
        self.create_service(Trigger, "lifelore/recognise", self._recognise)
        self._publish_masks()
        self._begin(self._perceive_clouds)
        if self._map:
            self._begin(self._follow_memory)

    def _begin(self, work: Callable[..., None], *given: Any) -> None:
        threading.Thread(target=work, args=given, daemon=True).start()

    def _try(self, work: Callable[..., Any], *given: Any) -> Any:
        """The result of `work`; None, and a line in the log, where Lifelore refuses or does not answer."""
        try:
            return work(*given)
        except (ValueError, OSError) as error:
            self.get_logger().error(str(error))
            return None

    def _publish_masks(self) -> None:
        for topic, publisher in self._masks.items():
            file = self._exports / MASKS[topic]
            if not file.is_file():
                self.get_logger().warning(f"{file} does not exist; {topic} stays silent")
                continue
            header = {"frame_id": self._frame, "stamp": self._now()}
            _publish(publisher, OccupancyGrid(), occupancy_grid(file) | {"header": header})

    def _follow_memory(self) -> None:
        """Write and publish the masks again whenever memory has changed."""
        seen, wait = None, threading.Event()
        while True:
            revision = self._try(memory_revision, self._url, self._token)
            if revision not in (None, seen):
                words = ("memory", "nav2", self._map, "--out", self._exports, *self._memory)
                if self._try(answer_of, self._program, *words):
                    self._publish_masks()
                seen = revision
            wait.wait(self._period)

    def _answer_way(self, message: String) -> None:
        # A way takes longer than a message may hold up the others.
        self._begin(self._try, self._find_way, message.data)

    def _find_way(self, text: str) -> None:
        start, goal = way_ends(text)
        ends = (f"--from={start}", f"--to={goal}", "--spacing=0.05")
        document = answer_of(self._program, "way", "--map", self._map, *ends, *self._memory)
        _publish(self._way, PathMessage(), way_fields(document, self._frame, self._now()))

    def _recognise(self, request: Any, response: Any) -> Any:
        """Which building the map shows, its pose, and where the known places are now, as JSON."""
        try:
            response.message = json.dumps(answer_of(self._program, "recognise", self._map, *self._memory))
            response.success = True
        except (ValueError, OSError) as error:
            response.success, response.message = False, str(error)
        return response

    def _now(self) -> dict[str, int]:
        stamp = self.get_clock().now().to_msg()
        return {"sec": stamp.sec, "nanosec": stamp.nanosec}

    def _take_cloud(self, message: PointCloud2) -> None:
        # Perceiving takes longer than a camera's frame, so an older cloud that still waits is dropped.
        with suppress(queue.Empty):
            self._clouds.get_nowait()
        self._clouds.put(message)

    def _perceive_clouds(self) -> None:
        while True:
            self._try(self._perceive, self._clouds.get())

    def _perceive(self, cloud: PointCloud2) -> None:
        scene, head = perceived(self._url, cloud_points(cloud), self._token), header_fields(cloud.header)
        _publish(self._facts, String(), facts_text(scene))
        _publish(self._detections, Detection3DArray(), detection_array(scene, head))
        _publish(self._relations, SpatialRelationArray(), relation_array(scene, head))


def _publish(publisher: Any, message: Any, fields: dict[str, Any]) -> None:
    set_message_fields(message, fields)
    publisher.publish(message)


def main() -> None:
    """Run the node until Ctrl-C."""
    rclpy.init()
    node = LifeloreNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
