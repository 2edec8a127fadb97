"""The verb `learn-relations`: scenes and what was said of them in, a model of the words out; kept in memory."""

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
class RelationLesson:
    """What is to be learnt from, and how; see `RelationClassifier`.

    Parameters
    ----------
    folder : str
        Holds a cloud of each scene, ``NAME.pcd`` (or ply, npz, npy), and may hold `planes.csv`.
    truth : str
        CSV with columns scene, a, b, relation, confidence.
    name : str
        Under which memory keeps the model; not the name of a file (`MODEL_SUFFIX`).
    method : {"trees", "displacement"}
    adjacent_gap : float
        Metres.
    several : bool
        Several relations may hold of one pair.
    labels : {"auto", "plain", "parts"}
        How a label field becomes objects, see `label_rule`.
    units : {"m", "mm"}
    up : "table", "z", or (3,) numbers, optional
        Where up is in each cloud's frame, see `to_scene`; default as `planes.csv` has it, else the table's plane.

    Raises
    ------
    InputError
        The name is that of a file.
    """

    folder: str
    truth: str
    name: str = DEFAULT_NAME
    method: str = "trees"
    adjacent_gap: float = ADJACENT_GAP
    several: bool = False
    labels: str = "auto"
    units: str = "m"
    up: Up | None = None

    def __post_init__(self) -> None:
        if self.name.endswith(MODEL_SUFFIX):
            raise InputError(
                f"name must not end in {MODEL_SUFFIX}, which means a file, got '{self.name}'; use out"
            )


def learn_relations(
    lesson: RelationLesson,
    memory: str | None = None,
    out: str | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """Train a model on a folder of scenes; keep it in memory, and in the file `out` where one is named.

    Without `memory` and with `out` no memory is opened. `notice` is called with one line for a person where labels
    were guessed to be parts of objects.

    Returns
    -------
    dict
        ``name``, ``scenes``, ``pairs`` (labels learnt from, by relation), ``not_near`` (labels that are certain
        enough, but of things too far apart to be learnt from; by relation), ``relations``, ``symmetric``,
        ``method``, ``adjacent_gap``, ``out``, ``memory``.

    Raises
    ------
    InputError
        A file breaks its rule, a scene of the truth has no cloud, or a label names an object that is not there.
    """
    model = RelationClassifier(lesson.method, adjacent_gap=lesson.adjacent_gap, multi_label=lesson.several)
    if out is not None:
        _check_out(out)
    truths = read_relations(lesson.truth)
    scenes, n_from_parts = look_at(lesson, truths, progress)
    model.fit_pairs(scenes, list(truths.values()))
    report = _report(lesson, model, truths)
    about = {key: report[key] for key in ("name", "scenes", "pairs", "method", "relations")}
    about["lifelore"] = version("lifelore")
    if out is not None:
        model.save(out, about)
    where = None
    if memory is not None or out is None:
        with open_memory(memory) as opened:
            where = opened.location
            remember(opened, lesson.name, model, about)
    if notice is not None and n_from_parts and lesson.labels == "auto":
        notice(f"the labels of {n_from_parts} of {len(scenes)} clouds {PARTS_NOTICE}")
    return {**report, "out": out, "memory": where}


def _check_out(out: str) -> None:
    if not out.endswith(MODEL_SUFFIX):
        raise InputError(f"out must end in {MODEL_SUFFIX}, by which perceive knows a model's file, got '{out}'")
    check_model_path(out)


def look_at(
    lesson: RelationLesson, truths: dict[str, tuple[PairLabel, ...]], progress: Progress | None = None
) -> tuple[list[ScenePairs], int]:
    """Read the clouds that the truths speak of, find their near pairs; and how many had parts for labels."""
    folder = Path(lesson.folder)
    planes_file = folder / "planes.csv"
    planes = read_planes(planes_file) if lesson.up is None and planes_file.is_file() else {}
    paths = [_cloud_of(folder, scene) for scene in truths]
    found, n_from_parts = [], 0
    for number, (scene, path) in enumerate(zip(truths, paths, strict=True)):
        cloud = read_cloud(path, units=lesson.units, labels=lesson.labels)
        n_from_parts += cloud.from_parts
        up = planes[scene][:3] if scene in planes else "table" if lesson.up is None else lesson.up
        found.append(scene_pairs(_upright(scene, cloud, up, truths[scene])))
        if progress is not None:
            progress(number + 1, len(paths), scene)
    return found, n_from_parts


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
    raise InputError(f"the truth speaks of scene '{scene}', but {folder} has no {scene}.pcd (nor ply, npz, npy)")


def _check_labels(scene: str, truth: Sequence[PairLabel], there: set[int]) -> None:
    for label in truth:
        if not {label.a, label.b} <= there:
            raise InputError(
                f"scene '{scene}': {label.relation}({label.a}, {label.b}) names an object that the cloud does not"
                f" have; it has {', '.join(map(str, sorted(there)))}"
            )


def _report(
    lesson: RelationLesson, model: RelationClassifier, truths: dict[str, tuple[PairLabel, ...]]
) -> dict[str, Any]:
    said = Counter(
        label.relation for truth in truths.values() for label in truth if label.confidence >= LEAST_CONFIDENCE
    )
    learnt = Counter(model.learnt_from)
    return {
        "name": lesson.name,
        "scenes": len(truths),
        "pairs": {name: learnt[name] for name in model.names},
        "not_near": dict(sorted((said - learnt).items())),
        "relations": list(model.names),
        "symmetric": sorted(model.symmetric),
        "method": model.method,
        "adjacent_gap": model.vocabulary.adjacent_gap,
    }


def remember(memory: Memory, name: str, model: RelationClassifier, about: dict[str, Any]) -> None:
    """Keep a model under a name; the newest of a name is the one that is recalled."""
    words = as_words(model_bytes(model.to_model(), about))
    record = Record(
        KIND, model_key(name), VERSION, "newest", np.arange(len(words)), words, {**about, "name": name}
    )
    memory.contribute("relations", [record], process=f"learn-relations {uuid4().hex}", seq=0, task=about)


def recall_relations(memory: Memory, name: str = DEFAULT_NAME) -> RelationClassifier:
    """The newest model of that name.

    Raises
    ------
    NotFoundError
        There is none.
    """
    record = memory.recall(KIND, model_key(name), VERSION)
    if record is None:
        known = sorted(str(about.get("name")) for _, _, about in memory.keys(KIND))
        hint = f"it has {', '.join(known)}" if known else "it has none; `lifelore learn-relations` trains one"
        raise NotFoundError(f"memory has no relation model '{name}': {hint}")
    stored = model_from_bytes(as_bytes(record.values), f"the relation model '{name}' in memory")
    return RelationClassifier.from_model(stored)


def model_key(name: str) -> str:
    """Under which key memory keeps the models of a name."""
    return hashlib.sha256(name.encode()).hexdigest()[:32]


def as_words(content: bytes) -> NDArray[np.int64]:
    """Bytes as 64-bit numbers, the first their length: what a record can hold.

    A shorter model leaves the tail of a longer one behind it; the length says where it ends.
    """
    padded = content + bytes(-len(content) % 8)
    return np.concatenate([[len(content)], np.frombuffer(padded, "<i8")]).astype(np.int64)


def as_bytes(words: NDArray[np.int64]) -> bytes:
    """The bytes of `as_words`."""
    return words[1:].astype("<i8").tobytes()[: int(words[0])]
