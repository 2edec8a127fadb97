"""Perception: point clouds in, relations between objects out (thesis ch. 2).

The sub-packages stand in the order of the data: `clouds` → `segmentation` → `separation` → `contacts` → `pairs` →
`trees` → `relations` → `reasoning` and `topology`. `scene` holds all layers of one scene, `scene_perception` runs
all steps, `scene_json` and `scene_graph` write a scene.

What users call can be imported from here, and is loaded when first used.
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.core.labelled_cloud import LabelledCloud as LabelledCloud
    from lifelore.perception.clouds.camera_intrinsics import CameraIntrinsics as CameraIntrinsics
    from lifelore.perception.clouds.cloud_file import read_cloud as read_cloud
    from lifelore.perception.clouds.point_cloud import PointCloud as PointCloud
    from lifelore.perception.contacts.contact_network import ContactPointNetwork as ContactPointNetwork
    from lifelore.perception.contacts.contact_settings import ContactSettings as ContactSettings
    from lifelore.perception.contacts.pair_networks import contact_networks as contact_networks
    from lifelore.perception.relations.relation_classifier import RelationClassifier as RelationClassifier
    from lifelore.perception.scene import Scene as Scene
    from lifelore.perception.scene_perception import perceived_scene as perceived_scene
    from lifelore.perception.segmentation.table_frame import to_scene as to_scene
    from lifelore.perception.trees.tree_training import TreeSettings as TreeSettings

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
