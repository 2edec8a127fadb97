"""The scenes of `bench segmentation`, without their labels, and what each method finds in them."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, tabletop_scenes
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier
from lifelore.perception.relations.relation_truth import read_relations
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings
from lifelore.perception.segmentation.table_frame import Up, segmented_scene, to_scene
from reproduction.chapter2.scenes.real_scenes import real_scenes_folder
from reproduction.chapter2.scoring.segmentation_scoring import ObjectOverlap, matched_objects, overlaps
from reproduction.chapter2.scoring.segmented_relations import RelationCounts, relation_counts

CURVATURE, GIVEN = "curvature", "labels given"
METHODS = {
    "convexity": SegmentationSettings(method="convexity"),
    "distance clusters": SegmentationSettings(method="clusters"),
    CURVATURE: SegmentationSettings(method="curvature"),
    "colour clusters": SegmentationSettings(method="colour"),
    GIVEN: None,
}
"""The ways to find objects; None: from the true labels."""
SEED, SHAPES = 7021, "held-out"
"""Of the simulated scenes; no parameter was chosen on them."""


@dataclass(frozen=True, eq=False)
class TrueScene:
    """Measured points of a scene with their labels, and the labels of its pairs; `up` as of `to_scene`."""

    name: str
    cloud: PointCloud
    truth: tuple[PairLabel, ...]
    up: Up


@dataclass(frozen=True, eq=False)
class FoundScene:
    """A scene as a method finds it; `seconds` of processor time to find objects, `all_seconds` with relations.

    `cuts` holds the confidence of each cut object, and whether it finds a true object.
    """

    cloud: LabelledCloud
    overlaps: list[ObjectOverlap]
    relations: RelationCounts
    seconds: float
    all_seconds: float
    cuts: list[tuple[float, bool]] = field(default_factory=list)


def real_true_scenes() -> list[TrueScene]:
    """The real scenes by name; none without their folder."""
    folder = real_scenes_folder()
    if folder is None:
        return []
    truths = read_relations(folder / "relations.csv")
    return [
        TrueScene(name, _measured(read_cloud(folder / f"{name}.pcd")), truths[name], "table")
        for name in sorted(truths)
    ]


def simulated_true_scenes(n: int) -> Iterator[TrueScene]:
    """The first `n` simulated scenes; their frame is the table's."""
    yield from map(simulated_true_scene, tabletop_scenes(n, SEED, TabletopSettings(shapes=SHAPES)))


def simulated_true_scene(scene: TabletopScene) -> TrueScene:
    """A simulated scene; its frame is the table's."""
    cloud = scene.cloud
    points = PointCloud(cloud.points, cloud.labels, cloud.colours, camera=cloud.camera)
    return TrueScene(scene.name, points, scene.truth, "z")


def found_scene(scene: TrueScene, method: str, model: RelationClassifier) -> FoundScene:
    """What a method of `METHODS` finds, and the relations that `model` perceives then."""
    settings = METHODS[method]
    cloud = scene.cloud if settings is None else unlabelled(scene)
    began = time.process_time()
    labelled, confidence = _scene(cloud, scene.up, settings)
    between = time.process_time()
    relations = perceived_scene(labelled, model).relations
    ended = time.process_time()
    found = overlaps(true_labels(scene), labelled.labels)
    stands_for = matched_objects(found)
    counts = relation_counts(scene.truth, relations, stands_for)
    cuts = [(sure, label in stands_for) for label, sure in confidence.items()]
    return FoundScene(labelled, found, counts, between - began, ended - began, cuts)


def unlabelled(scene: TrueScene) -> PointCloud:
    """The scene's cloud without its labels."""
    return PointCloud(scene.cloud.points, None, scene.cloud.colours, camera=scene.cloud.camera)


def true_labels(scene: TrueScene) -> NDArray[np.int64]:
    """(n,) labels of the scene's points."""
    labels = scene.cloud.labels
    if labels is None:
        raise InputError(f"scene {scene.name} must have labels")
    return labels


def _scene(
    cloud: PointCloud, up: Up, settings: SegmentationSettings | None
) -> tuple[LabelledCloud, Mapping[int, float]]:
    """Scene and confidences; if a scene shows too few colours to be cut by colour, it has no objects."""
    try:
        found = segmented_scene(cloud, up, settings)
        return found.cloud, found.confidence
    except InputError as error:
        if settings is None or settings.method != "colour" or "colours" not in str(error):
            raise
        bare = to_scene(cloud, up, SegmentationSettings(method="clusters"))
        return LabelledCloud(bare.points, np.minimum(bare.labels, 1), bare.colours, bare.camera), {}


def _measured(cloud: PointCloud) -> PointCloud:
    return cloud.only(cloud.measured)
