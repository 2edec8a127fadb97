"""Perception: point clouds in, relations between objects out (thesis ch. 2).

The sub-packages stand in the order of the data: `clouds` → `segmentation` → `separation` → `contacts` → `pairs` →
`trees` → `relations` → `reasoning` and `topology`. `scene` holds all layers of one scene, `scene_perception` runs
all steps, `scene_json` and `scene_graph` write a scene.

What users call can be imported from here, and is loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lifelore.core.labelled_cloud import LabelledCloud
    from lifelore.perception.clouds.camera_intrinsics import CameraIntrinsics
    from lifelore.perception.clouds.cloud_file import read_cloud
    from lifelore.perception.clouds.point_cloud import PointCloud
    from lifelore.perception.contacts.contact_network import ContactPointNetwork
    from lifelore.perception.contacts.contact_settings import ContactSettings
    from lifelore.perception.contacts.pair_networks import contact_networks
    from lifelore.perception.relations.relation_classifier import RelationClassifier
    from lifelore.perception.scene import Scene
    from lifelore.perception.scene_perception import perceived_scene
    from lifelore.perception.segmentation.table_frame import to_scene

__all__ = [
    "CameraIntrinsics",
    "ContactPointNetwork",
    "ContactSettings",
    "LabelledCloud",
    "PointCloud",
    "RelationClassifier",
    "Scene",
    "contact_networks",
    "perceived_scene",
    "read_cloud",
    "to_scene",
]

_HOME = {
    "CameraIntrinsics": "lifelore.perception.clouds.camera_intrinsics",
    "ContactPointNetwork": "lifelore.perception.contacts.contact_network",
    "ContactSettings": "lifelore.perception.contacts.contact_settings",
    "LabelledCloud": "lifelore.core.labelled_cloud",
    "PointCloud": "lifelore.perception.clouds.point_cloud",
    "RelationClassifier": "lifelore.perception.relations.relation_classifier",
    "Scene": "lifelore.perception.scene",
    "contact_networks": "lifelore.perception.contacts.pair_networks",
    "perceived_scene": "lifelore.perception.scene_perception",
    "read_cloud": "lifelore.perception.clouds.cloud_file",
    "to_scene": "lifelore.perception.segmentation.table_frame",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
