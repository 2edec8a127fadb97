"""The node: publishes the masks and a path of an export, and the objects and relations of each cloud it receives.

Untested on a robot. All conversions are in `conversions` and `detection3d`, which need no ROS.
"""

import os
import queue
import threading
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
from vision_msgs.msg import Detection3DArray

from lifelore_node.conversions import (
    cloud_points,
    facts_text,
    header_fields,
    occupancy_grid,
    path_poses,
    perceived,
)
from lifelore_node.detection3d import detection_array, relation_array

MASKS = {"keepout_mask": "keepout.yaml", "cost_mask": "costs.yaml"}
"""Topics of the masks, as in docs/nav2.md, and their files."""


class LifeloreNode(Node):
    """Exports to topics at the start; clouds to the service, one at a time, the newest first."""

    def __init__(self) -> None:
        super().__init__("lifelore_node")
        exports = Path(self.declare_parameter("exports", "exports").value)
        self._url = self.declare_parameter("url", "http://127.0.0.1:8321").value
        self._frame = self.declare_parameter("frame", "map").value
        # A parameter would show the token to every node.
        self._token = os.environ.get("LIFELORE_TOKEN", "")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        for topic, file in MASKS.items():
            self._publish_once(OccupancyGrid, topic, latched, occupancy_grid, exports / file)
        self._publish_once(PathMessage, "lifelore/path", latched, path_poses, exports / "paths.csv")
        self._facts = self.create_publisher(String, "lifelore/facts", 10)
        self._detections = self.create_publisher(Detection3DArray, "lifelore/detections", 10)
        self._relations = self.create_publisher(SpatialRelationArray, "lifelore/relations", 10)
        self._clouds: queue.Queue[PointCloud2] = queue.Queue(maxsize=1)
        self.create_subscription(PointCloud2, "points", self._take_cloud, qos_profile_sensor_data)
        threading.Thread(target=self._perceive_clouds, daemon=True).start()

    def _publish_once(self, kind: Any, topic: str, quality: QoSProfile, convert: Any, file: Path) -> None:
        if not file.is_file():
            self.get_logger().warning(f"{file} does not exist; {topic} stays silent")
            return
        message = kind()
        set_message_fields(message, convert(file))
        message.header.frame_id = self._frame
        message.header.stamp = self.get_clock().now().to_msg()
        self.create_publisher(kind, topic, quality).publish(message)

    def _take_cloud(self, message: PointCloud2) -> None:
        # Perceiving takes longer than a camera's frame, so an older cloud that still waits is dropped.
        with suppress(queue.Empty):
            self._clouds.get_nowait()
        self._clouds.put(message)

    def _perceive_clouds(self) -> None:
        while True:
            cloud = self._clouds.get()
            try:
                scene = perceived(self._url, cloud_points(cloud), self._token)
            except (ValueError, OSError) as error:
                self.get_logger().error(str(error))
                continue
            head = header_fields(cloud.header)
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
