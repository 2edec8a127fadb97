"""Trains a relation model on labelled scenes and stores it in memory or in a file (`lifelore learn-relations`).

In memory, the scenes stay beside the model; later lessons of the same name, also of other robots, add to them.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any
from warnings import catch_warnings

from lifelore.agent.perceive.relation_memory import (
    DEFAULT_NAME,
    LabelledScene,
    joined,
    recall_scenes,
    store_model,
)
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.protocols import Progress
from lifelore.core.relations import ADJACENT_GAP, PairLabel
from lifelore.memory import open_memory
from lifelore.memory.location import locate
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.label_rule import PARTS_NOTICE
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.pairs.scene_pairs import ScenePairs, scene_pairs
from lifelore.perception.relations.relation_classifier import LEAST_CONFIDENCE, RelationClassifier
from lifelore.perception.relations.relation_model_file import SUFFIX as MODEL_SUFFIX
from lifelore.perception.relations.relation_model_file import check_model_path
from lifelore.perception.relations.relation_truth import read_planes, read_relations
from lifelore.perception.segmentation.table_frame import Up, to_scene

SUFFIXES = (".pcd", ".ply", ".npz", ".npy")


@dataclass(frozen=True)
class LearnRelationsSettings:
    """Training scenes, and settings of `RelationClassifier`.

    Parameters
    ----------
    folder : str, optional
        Folder with a cloud of each scene, ``NAME.pcd`` (or ply, npz, npy), and optionally `planes.csv`; without
        it, the scenes that memory has for models of this name are all.
    truth : str, optional
        CSV with columns scene, a, b, relation, confidence; given together with `folder`.
    name : str
        Name of the model in memory; must not end in `MODEL_SUFFIX`, which means a file.
    method : {"trees", "displacement"}
    adjacent_gap : float
        Largest gap between adjacent objects, in metres.
    several : bool
        Whether a pair may have several relations.
    symmetric : tuple of str, optional
        The symmetric relations; all others then have a direction. None infers them from the labels.
    labels : {"auto", "plain", "parts"}
        How a label field becomes objects, see `label_rule`.
    units : {"m", "cm", "mm", "inch"}
    up : "table", "z", or (3,) numbers, optional
        Upward direction in each cloud's frame, see `to_scene`; default: from `planes.csv`, else the table's
        normal.
    anew : bool
        Whether to leave out the scenes that memory has for models of this name.

    Raises
    ------
    InputError
        The name means a file; of `folder` and `truth` one is missing; there is nothing to learn from.
    """

    folder: str | None = None
    truth: str | None = None
    name: str = DEFAULT_NAME
    method: str = "trees"
    adjacent_gap: float = ADJACENT_GAP
    several: bool = False
    symmetric: tuple[str, ...] | None = None
    labels: str = "auto"
    units: str = "m"
    up: Up | None = None
    anew: bool = False

    def __post_init__(self) -> None:
        if (self.folder is None) != (self.truth is None):
            missing = "truth" if self.truth is None else "folder"
            raise InputError(f"folder and truth belong together, but {missing} is missing; give both or neither")
        if self.folder is None and self.anew:
            raise InputError(
                "anew leaves the remembered scenes out, but there are no others; give a folder of scenes"
            )
        if self.name.endswith(MODEL_SUFFIX):
            raise InputError(
                f"name must not end in {MODEL_SUFFIX}, which means a file, got '{self.name}'; use out"
            )


def learn_relations(
    settings: LearnRelationsSettings,
    memory: str | None = None,
    out: str | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """Train a model on a folder of scenes; store it in memory, and in the file `out` if it is given.

    With `out` and without `memory`, no memory is opened. Otherwise the model also learns from the scenes that
    memory has for models of this name, and the new scenes stay there. A scene of a cloud that was there before
    replaces its labels. `notice` is called with each line for the user, such as that labels were
    interpreted as parts of objects.

    Returns
    -------
    dict
        ``name``, ``scenes``, ``remembered`` (number of the scenes that came from memory alone), ``pairs`` (number
        of labels used, by relation), ``not_near`` (number of labels with enough confidence but of objects too far
        apart, by relation), ``relations``, ``symmetric``, ``method``, ``adjacent_gap``, ``out``, ``memory``.

    Raises
    ------
    InputError
        A file breaks its rule, a scene of the truth has no cloud, a label names an object that the cloud does not
        have, or no folder is given and memory has no scene of this name.
    """
    model = RelationClassifier(
        settings.method,
        adjacent_gap=settings.adjacent_gap,
        multi_label=settings.several,
        symmetric=settings.symmetric,
    )
    if out is not None:
        _check_out(out)
    remembers = memory is not None or out is None
    if settings.truth is None and not remembers:
        raise InputError(
            "folder must be given where no memory is opened; name a memory, or give a folder of scenes"
        )
    truths = {} if settings.truth is None else read_relations(settings.truth)
    pairs, n_from_parts = read_scenes(settings, truths, progress)
    latest = [LabelledScene(one, truth) for one, truth in zip(pairs, truths.values(), strict=True)]
    earlier = _remembered(memory, settings.name) if remembers and not settings.anew else []
    scenes = joined(earlier, latest)
    if not scenes:
        raise InputError(f"memory has no scenes of '{settings.name}' to learn from; give a folder of scenes")
    _check_symmetric(settings.symmetric or (), [scene.truth for scene in scenes])
    with catch_warnings(record=notice is not None, action="always") as caught:
        model.fit([scene.pairs for scene in scenes], [scene.truth for scene in scenes])
    if notice is not None and caught:
        for each in caught:
            notice(str(each.message))
    report = _report(settings, model, scenes, len({scene.digest for scene in latest}))
    about = {key: report[key] for key in ("name", "scenes", "pairs", "method", "relations")}
    about["lifelore"] = version("lifelore")
    if out is not None:
        model.save(out, about)
    where = None
    if remembers:
        with open_memory(memory) as opened:
            where = opened.location
            store_model(opened, settings.name, model, about, latest)
    if notice is not None and n_from_parts and settings.labels == "auto":
        notice(f"the labels of {n_from_parts} of {len(truths)} clouds {PARTS_NOTICE}")
    return {**report, "out": out, "memory": where}


def _remembered(memory: str | None, name: str) -> list[LabelledScene]:
    """The scenes in a memory; a memory is not made before there is a model to store."""
    place = locate(memory)
    if isinstance(place, Path) and not place.exists():
        return []
    with open_memory(memory, create=False) as opened:
        return recall_scenes(opened, name)


def _check_symmetric(symmetric: Sequence[str], truths: Sequence[Sequence[PairLabel]]) -> None:
    """Refuse a declared name that no label has."""
    known = {label.relation for truth in truths for label in truth}
    if unknown := sorted(set(symmetric) - known):
        raise InputError(
            f"symmetric must name relations of the labels ({', '.join(sorted(known))}), got {', '.join(unknown)}"
        )


def _check_out(out: str) -> None:
    if not out.endswith(MODEL_SUFFIX):
        raise InputError(f"out must end in {MODEL_SUFFIX}, by which perceive recognises a model file, got '{out}'")
    check_model_path(out)


def read_scenes(
    settings: LearnRelationsSettings, truths: dict[str, tuple[PairLabel, ...]], progress: Progress | None = None
) -> tuple[list[ScenePairs], int]:
    """Near pairs of the cloud of each scene in the truths, and the number of clouds labelled by parts."""
    folder = Path(settings.folder or ".")
    planes_file = folder / "planes.csv"
    planes = read_planes(planes_file) if settings.up is None and planes_file.is_file() else {}
    paths = [_cloud_of(folder, scene) for scene in truths]
    scenes, n_from_parts = [], 0
    for number, (scene, path) in enumerate(zip(truths, paths, strict=True)):
        cloud = read_cloud(path, units=settings.units, labels=settings.labels)
        n_from_parts += cloud.from_parts
        up = planes[scene][:3] if scene in planes else "table" if settings.up is None else settings.up
        scenes.append(scene_pairs(_upright(scene, cloud, up, truths[scene])))
        if progress is not None:
            progress(number + 1, len(paths), scene)
    return scenes, n_from_parts


def _upright(scene: str, cloud: PointCloud, up: Up, truth: Sequence[PairLabel]) -> LabelledCloud:
    try:
        upright = to_scene(cloud, up)
    except InputError as error:
        raise InputError(f"scene '{scene}': {error}") from None
    _check_labels(scene, truth, {*upright.objects, *([TABLE] if upright.has_table else [])})
    return upright


def _cloud_of(folder: Path, scene: str) -> Path:
    if Path(scene).name != scene:
        raise InputError(f"scene must be the name of a cloud without folders, got '{scene}' in the truth")
    for suffix in SUFFIXES:
        if (path := folder / f"{scene}{suffix}").is_file():
            return path
    raise InputError(
        f"the truth names scene '{scene}', but {folder} has no {scene}.pcd (nor ply, npz, npy); add the cloud"
    )


def _check_labels(scene: str, truth: Sequence[PairLabel], present: set[int]) -> None:
    for label in truth:
        if not {label.a, label.b} <= present:
            raise InputError(
                f"scene '{scene}': {label.relation}({label.a}, {label.b}) names an object that the cloud does not"
                f" have; it has {', '.join(map(str, sorted(present)))}"
            )


def _report(
    settings: LearnRelationsSettings, model: RelationClassifier, scenes: Sequence[LabelledScene], n_latest: int
) -> dict[str, Any]:
    labelled = Counter(
        label.relation for scene in scenes for label in scene.truth if label.confidence >= LEAST_CONFIDENCE
    )
    learnt = Counter(model.learnt_from_)
    return {
        "name": settings.name,
        "scenes": len(scenes),
        "remembered": len(scenes) - n_latest,
        "pairs": {name: learnt[name] for name in model.names_},
        "not_near": dict(sorted((labelled - learnt).items())),
        "relations": list(model.names_),
        "symmetric": sorted(model.symmetric_),
        "method": model.method,
        "adjacent_gap": model.vocabulary.adjacent_gap,
    }
