"""Relation models in memory: the newest of a name, and the labelled scenes that the models of a name learn from.

A model is one record, and a newer one replaces it. A scene is a record of its own, so the scenes of several robots
stand side by side, and a model of all of them can be learnt anywhere. The key of a scene is a hash of the features
of its pairs: labels that are given anew replace those before.
"""

import hashlib
from collections.abc import Sequence
from typing import Any, NamedTuple
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.packed_arrays import PackedFormat
from lifelore.core.protocols import Record
from lifelore.core.relations import PairLabel
from lifelore.memory import Memory
from lifelore.memory.byte_words import bytes_of, words_of
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation_classifier import RelationClassifier
from lifelore.perception.relations.relation_model_file import model_bytes, model_from_bytes

KIND, EXAMPLES, VERSION = "relation_model", "relation_examples", 1
DEFAULT_NAME = "default"
_FORMAT = PackedFormat(
    "lifelore relation examples", 1, "labelled scene", "`lifelore learn-relations`", largest=2**28
)


class LabelledScene(NamedTuple):
    """The near pairs of a scene and their labels."""

    pairs: ScenePairs
    truth: tuple[PairLabel, ...]

    @property
    def digest(self) -> str:
        """Hash of what was perceived of the scene, without the labels."""
        features = self.pairs.features
        columns = (
            " ".join(features.names).encode(),
            *(
                array.tobytes()
                for array in (features.pairs, features.gaps, features.matrix, *self.pairs.displacements)
            ),
        )
        return hashlib.sha256(b"".join(columns)).hexdigest()[:32]


def store_model(
    memory: Memory,
    name: str,
    model: RelationClassifier,
    about: dict[str, Any],
    scenes: Sequence[LabelledScene] = (),
) -> None:
    """Store a model under a name, where a newer one replaces it, and the scenes that it learnt from beside it.

    Scenes that memory has with the same labels are not stored again.
    """
    words = as_words(model_bytes(model, about))
    key = model_key(name)
    records = [Record(KIND, key, VERSION, "newest", np.arange(len(words)), words, {**about, "name": name})]
    for record in {record.key: record for record in (scene_record(name, scene) for scene in scenes)}.values():
        held = memory.recall(EXAMPLES, record.key, VERSION)
        if held is None or not np.array_equal(held.values[: len(record.values)], record.values):
            records.append(record)
    memory.contribute("relations", records, process=f"learn-relations {uuid4().hex}", seq=0, task=about)


def scene_record(name: str, scene: LabelledScene) -> Record:
    """The record of a scene from which models of a name learn."""
    words, key = as_words(_packed(scene)), f"{model_key(name)}/{scene.digest}"
    return Record(EXAMPLES, key, VERSION, "newest", np.arange(len(words)), words, {"name": name})


def recall_model(memory: Memory, name: str = DEFAULT_NAME) -> RelationClassifier:
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
    return model_from_bytes(as_bytes(record.values), f"the relation model '{name}' in memory")


def recall_scenes(memory: Memory, name: str) -> list[LabelledScene]:
    """The labelled scenes that memory has for models of this name, in the order of their hashes.

    Raises
    ------
    InputError
        A scene was written by a newer Lifelore, or is damaged.
    """
    where = f"a labelled scene of '{name}' in memory"
    found = [memory.recall(EXAMPLES, key, VERSION) for key in _keys(memory, name)]
    return [_unpacked(as_bytes(record.values), where) for record in found if record is not None]


def scenes_not_learnt(memory: Memory, name: str) -> int:
    """Number of labelled scenes in memory beyond those that the newest model of this name has learnt from."""
    abouts = {key: about for key, _, about in memory.keys(KIND)}
    learnt = abouts.get(model_key(name), {}).get("scenes", 0)
    return max(0, len(_keys(memory, name)) - int(learnt))


def _keys(memory: Memory, name: str) -> list[str]:
    prefix = f"{model_key(name)}/"
    return [key for key, version, _ in memory.keys(EXAMPLES) if key.startswith(prefix) and version == VERSION]


def _packed(scene: LabelledScene) -> bytes:
    features, moved = scene.pairs.features, scene.pairs.displacements
    header = {
        "columns": list(features.names),
        "contacts": [len(one) for one in moved],
        "labels": [[label.a, label.b, label.relation, label.confidence] for label in scene.truth],
    }
    return _FORMAT.pack(
        header,
        {
            "matrix": features.matrix,
            "pairs": features.pairs,
            "gaps": features.gaps,
            "displacements": np.concatenate([np.empty((0, 3)), *moved]),
        },
    )


def _unpacked(content: bytes, where: str) -> LabelledScene:
    header, arrays = _FORMAT.unpack(content, where)
    try:
        ends = np.cumsum(header["contacts"], dtype=np.int64)
        features = PairFeatures(tuple(header["columns"]), arrays["matrix"], arrays["pairs"], arrays["gaps"])
        moved = tuple(np.split(arrays["displacements"], ends)[:-1])
        truth = tuple(PairLabel(int(a), int(b), str(r), int(c)) for a, b, r, c in header["labels"])
        if features.matrix.shape != (len(features.pairs), len(features.names)) or len(moved) * 2 != len(
            features.pairs
        ):
            raise ValueError("its arrays do not fit each other")
    except (KeyError, TypeError, ValueError) as error:
        raise _FORMAT.damaged(where, error) from None
    return LabelledScene(ScenePairs(features, moved), truth)


def joined(earlier: Sequence[LabelledScene], latest: Sequence[LabelledScene]) -> list[LabelledScene]:
    """All scenes, each once: labels of the latest count.

    Raises
    ------
    InputError
        Earlier scenes were perceived by another version of Lifelore, whose features differ.
    """
    scenes = {scene.digest: scene for scene in (*earlier, *latest)}
    columns = {scene.pairs.features.names for scene in scenes.values()}
    if len(columns) > 1:
        raise InputError(
            "the remembered scenes have other features than those of this version; learn from the clouds again"
            " under another --name"
        )
    return list(scenes.values())


def model_key(name: str) -> str:
    """The key of a model name in memory."""
    return hashlib.sha256(name.encode()).hexdigest()[:32]


def as_words(content: bytes) -> NDArray[np.int64]:
    """Bytes as 64-bit integers for a record; the first integer is the number of bytes.

    A shorter model does not overwrite the end of a longer one, so the reader needs the length.
    """
    return np.concatenate([[len(content)], words_of(content)])


def as_bytes(words: NDArray[np.int64]) -> bytes:
    """Bytes of the integers of `as_words`."""
    return bytes_of(words[1:], int(words[0]))
