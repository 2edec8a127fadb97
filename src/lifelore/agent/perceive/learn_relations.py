"""Trains a relation model on labelled scenes and stores it in memory or in a file (`lifelore learn-relations`)."""

import hashlib
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.protocols import Progress, Record
from lifelore.core.relations import ADJACENT_GAP, PairLabel
from lifelore.memory import Memory, open_memory
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.label_rule import PARTS_NOTICE
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.pairs.scene_pairs import ScenePairs, scene_pairs
from lifelore.perception.relations.relation_classifier import LEAST_CONFIDENCE, RelationClassifier
from lifelore.perception.relations.relation_model_file import SUFFIX as MODEL_SUFFIX
from lifelore.perception.relations.relation_model_file import (
    check_model_path,
    model_bytes,
    model_from_bytes,
)
from lifelore.perception.relations.relation_truth import read_planes, read_relations
from lifelore.perception.segmentation.table_frame import Up, to_scene

KIND, VERSION = "relation_model", 1
DEFAULT_NAME = "default"
SUFFIXES = (".pcd", ".ply", ".npz", ".npy")


@dataclass(frozen=True)
class LearnRelationsSettings:
    """Training scenes, and settings of `RelationClassifier`.

    Parameters
    ----------
    folder : str
        Folder with a cloud of each scene, ``NAME.pcd`` (or ply, npz, npy), and optionally `planes.csv`.
    truth : str
        CSV with columns scene, a, b, relation, confidence.
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
    units : {"m", "mm"}
    up : "table", "z", or (3,) numbers, optional
        Upward direction in each cloud's frame, see `to_scene`; default: from `planes.csv`, else the table's
        normal.

    Raises
    ------
    InputError
        The name means a file.
    """

    folder: str
    truth: str
    name: str = DEFAULT_NAME
    method: str = "trees"
    adjacent_gap: float = ADJACENT_GAP
    several: bool = False
    symmetric: tuple[str, ...] | None = None
    labels: str = "auto"
    units: str = "m"
    up: Up | None = None

    def __post_init__(self) -> None:
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

    With `out` and without `memory`, no memory is opened. `notice` is called with one line for the user if labels
    were interpreted as parts of objects.

    Returns
    -------
    dict
        ``name``, ``scenes``, ``pairs`` (number of labels used, by relation), ``not_near`` (number of labels with
        enough confidence but of objects too far apart, by relation), ``relations``, ``symmetric``,
        ``method``, ``adjacent_gap``, ``out``, ``memory``.

    Raises
    ------
    InputError
        A file breaks its rule, a scene of the truth has no cloud, or a label names an object that the cloud does
        not have.
    """
    model = RelationClassifier(
        settings.method,
        adjacent_gap=settings.adjacent_gap,
        multi_label=settings.several,
        symmetric=settings.symmetric,
    )
    if out is not None:
        _check_out(out)
    truths = read_relations(settings.truth)
    _check_symmetric(settings.symmetric or (), truths)
    scenes, n_from_parts = read_scenes(settings, truths, progress)
    model.fit_pairs(scenes, list(truths.values()))
    report = _report(settings, model, truths)
    about = {key: report[key] for key in ("name", "scenes", "pairs", "method", "relations")}
    about["lifelore"] = version("lifelore")
    if out is not None:
        model.save(out, about)
    where = None
    if memory is not None or out is None:
        with open_memory(memory) as opened:
            where = opened.location
            store_model(opened, settings.name, model, about)
    if notice is not None and n_from_parts and settings.labels == "auto":
        notice(f"the labels of {n_from_parts} of {len(scenes)} clouds {PARTS_NOTICE}")
    return {**report, "out": out, "memory": where}


def _check_symmetric(symmetric: Sequence[str], truths: dict[str, tuple[PairLabel, ...]]) -> None:
    """Refuse a declared name that no label has."""
    known = {label.relation for truth in truths.values() for label in truth}
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
    folder = Path(settings.folder)
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
    settings: LearnRelationsSettings, model: RelationClassifier, truths: dict[str, tuple[PairLabel, ...]]
) -> dict[str, Any]:
    labelled = Counter(
        label.relation for truth in truths.values() for label in truth if label.confidence >= LEAST_CONFIDENCE
    )
    learnt = Counter(model.learnt_from_)
    return {
        "name": settings.name,
        "scenes": len(truths),
        "pairs": {name: learnt[name] for name in model.names_},
        "not_near": dict(sorted((labelled - learnt).items())),
        "relations": list(model.names_),
        "symmetric": sorted(model.symmetric_),
        "method": model.method,
        "adjacent_gap": model.vocabulary.adjacent_gap,
    }


def store_model(memory: Memory, name: str, model: RelationClassifier, about: dict[str, Any]) -> None:
    """Store a model in memory under a name; a newer model replaces it."""
    words = as_words(model_bytes(model.to_model(), about))
    record = Record(
        KIND, model_key(name), VERSION, "newest", np.arange(len(words)), words, {**about, "name": name}
    )
    memory.contribute("relations", [record], process=f"learn-relations {uuid4().hex}", seq=0, task=about)


def recall_relations(memory: Memory, name: str = DEFAULT_NAME) -> RelationClassifier:
    """The newest model of this name in memory.

    Raises
    ------
    NotFoundError
        There is no such model.
    """
    record = memory.recall(KIND, model_key(name), VERSION)
    if record is None:
        known = sorted(str(about.get("name")) for _, _, about in memory.keys(KIND))
        hint = f"it has {', '.join(known)}" if known else "it has none; `lifelore learn-relations` trains one"
        raise NotFoundError(f"memory has no relation model '{name}': {hint}")
    stored = model_from_bytes(as_bytes(record.values), f"the relation model '{name}' in memory")
    return RelationClassifier.from_model(stored)


def model_key(name: str) -> str:
    """The key of a model name in memory."""
    return hashlib.sha256(name.encode()).hexdigest()[:32]


def as_words(content: bytes) -> NDArray[np.int64]:
    """Bytes as 64-bit integers for a record; the first integer is the number of bytes.

    A shorter model does not overwrite the end of a longer one, so the reader needs the length.
    """
    padded = content + bytes(-len(content) % 8)
    return np.concatenate([[len(content)], np.frombuffer(padded, "<i8")]).astype(np.int64)


def as_bytes(words: NDArray[np.int64]) -> bytes:
    """Bytes of the integers of `as_words`."""
    return words[1:].astype("<i8").tobytes()[: int(words[0])]
