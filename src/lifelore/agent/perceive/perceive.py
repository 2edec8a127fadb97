"""Perceives the objects, contacts and spatial relations of a point cloud (`lifelore perceive`)."""

import os
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from lifelore.agent.perceive.scene_files import SceneFiles, check_scene_files, write_scene_files
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.label_rule import PARTS_NOTICE
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.relations.relation_model_file import SUFFIX as MODEL_SUFFIX
from lifelore.perception.scene_json import DIGITS, scene_document
from lifelore.perception.segmentation.distance_segmentation import SegmentationSettings
from lifelore.perception.segmentation.region import Region
from lifelore.perception.segmentation.scene_warnings import scene_warnings
from lifelore.perception.segmentation.table_frame import EVERYWHERE, Up, segmented_scene

Source = str | os.PathLike[str] | NDArray | PointCloud
"""A source for `read_cloud`, or a cloud."""
STAGES = ("reading", "finding objects", "finding contacts and relations", "drawing conclusions", "writing")


@dataclass(frozen=True)
class PerceiveSettings:
    """How a cloud is read, segmented and classified.

    Parameters
    ----------
    up : "table", "z", or (3,) numbers
        Upward direction in the cloud's frame, see `to_scene`.
    units : {"m", "mm"}
    labels : {"auto", "plain", "parts"}
        How a label field becomes objects, see `label_rule`.
    segmentation : SegmentationSettings, optional
        Segmentation of a cloud without labels, default by distance; with a labelled cloud it is an error.
    model : str, optional
        A file of ``learn-relations --out``, or the name of a model in memory; default: the shipped model.
    memory : str, optional
        Memory that holds the named model.
    region : Region
        Where objects are looked for.

    Raises
    ------
    InputError
        `memory` is given without the name of a model.
    """

    up: Up = "table"
    units: str = "m"
    labels: str = "auto"
    segmentation: SegmentationSettings | None = None
    model: str | None = None
    memory: str | None = None
    region: Region = EVERYWHERE

    def __post_init__(self) -> None:
        if self.memory is not None and (self.model is None or is_file_name(self.model)):
            raise InputError(
                "memory needs the name of a model in it, but"
                f" {'no model is named' if self.model is None else f'{self.model} is a file'}: leave memory out"
            )


def is_file_name(model: str) -> bool:
    """Whether the name of a model means a file, not a model in memory."""
    return model.endswith(MODEL_SUFFIX)


DEFAULT = PerceiveSettings()
NO_FILES = SceneFiles()


def perceive(
    source: Source,
    settings: PerceiveSettings = DEFAULT,
    *,
    pddl: str | None = None,
    dot: str | None = None,
    plot: str | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """Perceive a scene.

    Parameters
    ----------
    source : path, (n, 3) array or PointCloud
        A source that `read_cloud` reads, or a cloud (for example from a rosbag).
    settings : PerceiveSettings
    pddl, dot, plot : str, optional
        Files to write: a planning problem (its domain beside it, as ``NAME-domain.pddl``), a graph for Graphviz,
        a picture (``NAME.png``).
    progress : Progress, optional
        Called as each of the `STAGES` begins.
    notice : callable, optional
        Called with one line for the user if labels were interpreted as parts of objects.

    Returns
    -------
    dict
        The document of `scene_json`, with the contact points of pairs that support or are adjacent to each other,
        and ``warnings``.

    Raises
    ------
    InputError
        The cloud, a setting or a file name breaks its rule, or two files have the same path.
    NotFoundError
        Memory has no model of this name, or there is no memory.
    StoreError
        A file cannot be written.
    """
    files = SceneFiles(pddl, dot, plot)
    check_scene_files(files, files_read([source], settings))
    return perceived(source, model_of(settings), settings, files, progress, notice)


def perceived(
    source: Source,
    model: RelationClassifier,
    settings: PerceiveSettings = DEFAULT,
    files: SceneFiles = NO_FILES,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """As `perceive`, with a loaded model and checked files."""
    began = time.perf_counter()
    _report_stage(progress, 0)
    cloud = _read(source, settings)
    _report_stage(progress, 1)
    segmented = segmented_scene(cloud, settings.up, settings.segmentation, settings.region)
    _report_stage(progress, 2)
    # Near pairs without support or adjacency do not belong to the contact network.
    scene = perceived_scene(segmented.cloud, model).without_unrelated_contacts
    _report_stage(progress, 3)
    document = scene_document(scene)
    document["warnings"] = [asdict(warning) for warning in scene_warnings(segmented)]
    document["seconds"] = round(time.perf_counter() - began, DIGITS)
    _report_stage(progress, 4)
    write_scene_files(files, scene, document)
    if notice is not None and cloud.from_parts and settings.labels == "auto":
        notice(f"the labels {PARTS_NOTICE}")
    return document


def files_read(sources: Iterable[Source], settings: PerceiveSettings) -> list[str | os.PathLike[str]]:
    """Paths of the files that are read, with the model's; they must not be overwritten."""
    read = [*sources, settings.model if settings.model and is_file_name(settings.model) else None]
    return [path for path in read if isinstance(path, str | os.PathLike)]


def _report_stage(progress: Progress | None, stage: int) -> None:
    if progress is not None:
        progress(stage, len(STAGES), STAGES[stage])


def _read(source: Source, settings: PerceiveSettings) -> PointCloud:
    if not isinstance(source, PointCloud):
        source = read_cloud(source, units=settings.units, labels=settings.labels)
    if settings.segmentation is not None and source.is_labelled:
        raise InputError(
            "segmentation (--segment) needs a cloud without labels, but this cloud has labels: leave it out"
        )
    return source


def model_of(settings: PerceiveSettings) -> RelationClassifier:
    """Load the relation model of the settings; a memory is only read."""
    if settings.model is None:
        return shipped_model()
    if is_file_name(settings.model):
        return RelationClassifier.load(settings.model)
    from lifelore.agent.perceive.learn_relations import recall_relations
    from lifelore.memory import open_memory
    from lifelore.memory.location import locate

    place = locate(settings.memory)
    if isinstance(place, Path) and not os.path.exists(place):
        raise NotFoundError(
            f"memory has no relation model '{settings.model}': there is no memory at {place};"
            " `lifelore learn-relations` trains one, and a model in a file is called NAME.npz"
        )
    with open_memory(settings.memory, read_only=True) as memory:
        return recall_relations(memory, settings.model)
