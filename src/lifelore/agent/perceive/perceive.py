"""Perceives the objects, contacts and spatial relations of a point cloud (`lifelore perceive`).

The cloud is read before the modules that perceive it are imported, so that a bad file is refused at once.
"""

import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from numpy.typing import NDArray

from lifelore.agent.perceive.scene_files import FileNames, SceneFiles, check_scene_files, write_scene_files
from lifelore.agent.perceive.source_files import NO_SOURCE_FILES, SourceFiles, read_source
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress
from lifelore.perception.clouds.label_rule import PARTS_NOTICE
from lifelore.perception.clouds.point_cloud import PointCloud

if TYPE_CHECKING:
    from lifelore.perception.reasoning.planning_goal import Statement
    from lifelore.perception.reasoning.scene_plan import Solver
    from lifelore.perception.relations.relation_classifier import RelationClassifier
    from lifelore.perception.scene import Scene
    from lifelore.perception.segmentation.object_segmentation import SegmentationSettings
    from lifelore.perception.segmentation.region import Region
    from lifelore.perception.segmentation.table_frame import Up

Source = str | os.PathLike[str] | NDArray | PointCloud
"""A source for `read_cloud`, or a cloud."""
STAGES = ("reading", "finding objects", "finding contacts and relations", "drawing conclusions", "writing")


@dataclass(frozen=True)
class PerceiveSettings:
    """Settings of `perceive`: reading, segmentation and classification.

    Parameters
    ----------
    up : "table", "z", or (3,) numbers
        Upward direction in the cloud's frame, see `to_scene`.
    units : {"m", "cm", "mm", "inch"}
    labels : {"auto", "plain", "parts"}
        How a label field becomes objects, see `label_rule`.
    segmentation : SegmentationSettings, optional
        Segmentation of a cloud without labels, default by convexity; with a labelled cloud it is an error.
    model : str, optional
        A file of ``learn-relations --out``, or the name of a model in memory; default: the shipped model.
    memory : str, optional
        Memory that holds the named model.
    min_confidence : float, optional
        Least probability, in [0, 1], of facts in the document, the graph and the planning problem; default: 0, and
        `planning_state.PLAN_CONFIDENCE` for the planning problem.
    goal : str, optional
        Goal of the planning problem, see `planning_goal`.
    beside : SourceFiles
        Files beside the cloud: intrinsics and colours of a depth image, masks of objects.
    region : Region, optional
        Where objects are looked for; by default everywhere.
    with_masks : bool
        Whether the document holds each object's pixels or point numbers, see `object_mask`.
    planner : Solver, optional
        Solves the planning problem of the `goal`, such as `lifelore.bridges.planner.solve`; the document then has
        the ``plan`` of `plan_json`. By default nothing is solved.

    Raises
    ------
    InputError
        `memory` is given without the name of a model, `min_confidence` is no probability, `goal` is no goal, or
        a planner has no goal.

    Examples
    --------
    >>> PerceiveSettings(up="z", units="mm").labels
    'auto'
    """

    up: "Up" = "table"
    units: str = "m"
    labels: str = "auto"
    segmentation: "SegmentationSettings | None" = None
    model: str | None = None
    memory: str | None = None
    min_confidence: float | None = None
    goal: str | None = None
    beside: SourceFiles = NO_SOURCE_FILES
    region: "Region | None" = None
    with_masks: bool = False
    planner: "Solver | None" = None

    def __post_init__(self) -> None:
        if self.min_confidence is not None and not 0 <= self.min_confidence <= 1:
            raise InputError(f"min_confidence must be a probability from 0 to 1, got {self.min_confidence!r}")
        if self.planner is not None and self.goal is None:
            raise InputError("plan (--plan) needs a goal (--goal GOAL), such as on(o2, o3)")
        _ = self.statements
        if self.memory is not None and (self.model is None or is_file_name(self.model)):
            raise InputError(
                "memory needs the name of a model in it, but"
                f" {'no model is named' if self.model is None else f'{self.model} is a file'}: leave memory out"
            )

    @property
    def statements(self) -> "tuple[Statement, ...]":
        """The statements of the goal; none without a goal."""
        if self.goal is None:
            return ()
        from lifelore.perception.reasoning.planning_goal import read_goal

        return read_goal(self.goal)


def read_up(text: str) -> "Up":
    """The upward direction that a user writes: ``table``, ``z`` or ``X,Y,Z``; see `segmented_scene`.

    Raises
    ------
    InputError
        The text has a comma, but is not of numbers.
    """
    if "," not in text:
        return text  # type: ignore[return-value]  # other words are refused where the scene is made
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"up must be table, z or X,Y,Z, three numbers, got '{text}'") from None


def read_region(roi: str | None, max_range: float | None) -> "Region | None":
    """The region that a user writes: ``XMIN,XMAX,YMIN,YMAX,ZMIN,ZMAX`` and a range, metres; None where none is.

    Raises
    ------
    InputError
        A value breaks the rule of `Region`.
    """
    if roi is None and max_range is None:
        return None
    from lifelore.perception.segmentation.region import AXES, Region

    try:
        box = None if roi is None else tuple(float(part) for part in roi.split(","))
    except ValueError:
        raise InputError(f"roi must be {','.join(AXES)}, six numbers, got '{roi}'") from None
    return Region(box, max_range)


def check_goal(settings: PerceiveSettings, pddl: str | None) -> None:
    """Raise InputError for a goal that is neither planned for nor written to a planning problem."""
    if settings.goal is not None and pddl is None and settings.planner is None:
        raise InputError("goal needs a plan (--plan), or a planning problem to write it to (--pddl FILE): add one")


def check_settings(settings: PerceiveSettings, pddl: str | None) -> None:
    """Raise InputError for settings that would fail for every cloud."""
    from lifelore.perception.clouds.cloud_scale import check_units
    from lifelore.perception.clouds.label_rule import check_rule
    from lifelore.perception.segmentation.table_frame import check_up

    check_units(settings.units)
    check_rule(settings.labels)
    check_up(settings.up)
    check_goal(settings, pddl)


def is_file_name(model: str) -> bool:
    """Whether the name of a model means a file, not a model in memory."""
    from lifelore.perception.relations.relation_model_file import SUFFIX

    return model.endswith(SUFFIX)


DEFAULT = PerceiveSettings()
NO_FILES = SceneFiles()


def perceive(
    source: Source,
    settings: PerceiveSettings = DEFAULT,
    *,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
    **files: Unpack[FileNames],
) -> dict[str, Any]:
    """Perceive a scene.

    Parameters
    ----------
    source : path, (n, 3) array or PointCloud
        A source that `read_cloud` reads, a depth image (with `settings.beside.intrinsics`), or a cloud (for
        example from a rosbag).
    settings : PerceiveSettings
    progress : Progress, optional
        Called as each of the `STAGES` begins.
    notice : callable, optional
        Called with one line for the user if labels were interpreted as parts of objects.
    pddl, dot, plot, masks_out, log, recorder : optional
        Files to write, see `SceneFiles`: a planning problem (its domain beside it, as ``NAME-domain.pddl``), a
        graph for Graphviz, a picture, a label image (both ``NAME.png``), a log.

    Returns
    -------
    dict
        The document of `scene_json`, with the contact points of pairs that support or are adjacent to each other,
        and ``warnings``; with a planner ``plan``. A goal that no plan can reach is a warning, or the reason of the
        plan.

    Raises
    ------
    InputError
        The cloud, a setting or a file name breaks its rule, or two files have the same path.
    NotFoundError
        Memory has no model of this name, or there is no memory.
    StoreError
        A file cannot be written.

    Examples
    --------
    >>> import numpy as np
    >>> plane = np.stack(np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 1, 30)), -1).reshape(-1, 2)
    >>> plate = lambda side, z, label: np.column_stack([side * plane, np.full(900, z), np.full(900, label)])
    >>> cloud = np.concatenate([plate(1, 0, 1), plate(0.1, 0.05, 2), plate(0.1, 0.06, 3)])
    >>> document = perceive(cloud, PerceiveSettings(up="z"))
    >>> [found["id"] for found in document["objects"]]
    [2, 3]
    """
    asked = SceneFiles(**files)
    check_goal(settings, asked.pddl)
    check_scene_files([asked], files_read([source], settings))
    model = None if settings.model is None else model_of(settings, notice)
    return perceived(source, model, settings, asked, progress, notice)


def perceived(
    source: Source,
    model: "RelationClassifier | None",
    settings: PerceiveSettings = DEFAULT,
    files: SceneFiles = NO_FILES,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """As `perceive`, with a loaded model, or None for the shipped model, and checked files."""
    cloud, scene, document = scene_and_document(source, model, settings, progress)
    _report_stage(progress, 4)
    write_scene_files(files, scene, document, settings.min_confidence, settings.statements)
    if notice is not None and cloud.from_parts and settings.labels == "auto":
        notice(f"the labels {PARTS_NOTICE}")
    return document


def scene_and_document(
    source: Source,
    model: "RelationClassifier | None" = None,
    settings: PerceiveSettings = DEFAULT,
    progress: Progress | None = None,
) -> "tuple[PointCloud, Scene, dict[str, Any]]":
    """The cloud as it was read, its scene, and the document of `perceive`; no file is written."""
    began = time.perf_counter()
    _report_stage(progress, 0)
    cloud = read_scene(source, settings)
    reading = time.perf_counter() - began
    from lifelore.perception.reasoning.support_warnings import support_warnings
    from lifelore.perception.relations.relation_classifier import shipped_model
    from lifelore.perception.scene_json import DIGITS, scene_document
    from lifelore.perception.scene_perception import perceived_scene
    from lifelore.perception.segmentation.scene_warnings import scene_warnings
    from lifelore.perception.segmentation.table_frame import EVERYWHERE, segmented_scene

    model = model or shipped_model()
    began = time.perf_counter() - reading  # without imports and the model
    _report_stage(progress, 1)
    segmented = segmented_scene(cloud, settings.up, settings.segmentation, settings.region or EVERYWHERE)
    _report_stage(progress, 2)
    # Near pairs without support or adjacency do not belong to the contact network.
    scene = perceived_scene(segmented.cloud, model).without_unrelated_contacts
    _report_stage(progress, 3)
    document = scene_document(
        scene,
        min_confidence=settings.min_confidence or 0.0,
        cut_confidence=segmented.confidence,
        with_masks=settings.with_masks,
    )
    warnings = (*scene_warnings(segmented), *support_warnings(scene))
    document["warnings"] = [asdict(warning) for warning in warnings]
    document["seconds"] = round(time.perf_counter() - began, DIGITS)
    if settings.statements:
        _add_plan(document, scene, settings, segmented.confidence)
    return cloud, scene, document


def _add_plan(
    document: dict[str, Any], scene: "Scene", settings: PerceiveSettings, cut_confidence: Mapping[int, float]
) -> None:
    """Add the plan for the goal; without a planner a warning where no plan can reach it."""
    from lifelore.agent.perceive.plan_json import plan_document
    from lifelore.perception.reasoning.planning_state import PLAN_CONFIDENCE, scene_state
    from lifelore.perception.reasoning.scene_plan import no_plan_reason, scene_plan

    least = PLAN_CONFIDENCE if settings.min_confidence is None else settings.min_confidence
    if settings.planner is not None:
        plan = scene_plan(scene, settings.statements, settings.planner, least, cut_confidence)
        document["plan"] = plan_document(plan, document["objects"])
    elif reason := no_plan_reason(scene, scene_state(scene, least), settings.statements):
        document["warnings"].append(
            {"code": "goal_out_of_reach", "message": f"no plan reaches the goal: {reason}"}
        )


def files_read(sources: Iterable[Source], settings: PerceiveSettings) -> list[str | os.PathLike[str]]:
    """Paths of the files that are read, with the model's; they must not be overwritten."""
    sources = list(sources)
    beside = [path for source in sources for path in settings.beside.of(source).paths]
    read = [*sources, *beside, settings.model if settings.model and is_file_name(settings.model) else None]
    return [path for path in read if isinstance(path, str | os.PathLike)]


def _report_stage(progress: Progress | None, stage: int) -> None:
    if progress is not None:
        progress(stage, len(STAGES), STAGES[stage])


def read_scene(source: Source, settings: PerceiveSettings) -> PointCloud:
    """Read the cloud of a source, with its files beside it; refuse a segmentation of a labelled cloud."""
    cloud = read_source(source, settings.units, settings.labels, settings.up, settings.beside)
    if settings.segmentation is not None and cloud.is_labelled:
        raise InputError("segmentation (--set segment=METHOD) needs a cloud without labels: leave it out")
    return cloud


def model_of(settings: PerceiveSettings, notice: Callable[[str], None] | None = None) -> "RelationClassifier":
    """Load the relation model of the settings; a memory is only read.

    `notice` is called with one line if memory has labelled scenes that the model has not learnt from.
    """
    from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model

    if settings.model is None:
        return shipped_model()
    if is_file_name(settings.model):
        return RelationClassifier.load(settings.model)
    from lifelore.agent.perceive.relation_memory import recall_model, scenes_not_learnt
    from lifelore.memory import open_memory
    from lifelore.memory.location import locate

    place = locate(settings.memory)
    if isinstance(place, Path) and not os.path.exists(place):
        raise NotFoundError(
            f"memory has no relation model '{settings.model}': there is no memory at {place};"
            " `lifelore learn-relations` trains one, and a model in a file is called NAME.npz"
        )
    with open_memory(settings.memory, read_only=True) as memory:
        model = recall_model(memory, settings.model)
        if notice is not None and (new := scenes_not_learnt(memory, settings.model)):
            place = "" if settings.memory is None else f" --memory {memory.location}"
            notice(
                f"the model '{settings.model}' has not learnt from {new} of the labelled scenes in memory yet:"
                f" lifelore learn-relations --name {settings.model}{place}"
            )
        return model
