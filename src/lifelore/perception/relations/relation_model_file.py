"""A fitted `RelationClassifier` as one npz of arrays and a JSON text; no pickle; equal models, equal bytes."""

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.atomic_write import whole_file
from lifelore.core.errors import InputError, StoreError
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.relations.displacement_relations import DisplacementRelations, NeighbourSettings
from lifelore.perception.relations.relation_classifier import RelationClassifier
from lifelore.perception.relations.relation_model_check import (
    check_classes,
    check_displacements,
    check_header,
    check_trees,
)
from lifelore.perception.trees.tree_ensemble import TreeEnsemble
from lifelore.perception.trees.tree_relations import TreeRelations

FORMAT = "lifelore relation model"
VERSION = 1
SUFFIX = ".npz"
"""End of the name of every relation model file."""
LARGEST = 2**28
"""Bytes that a model may unpack to: a stranger's file must not fill the memory."""
SHIPPED = Path(__file__).parent / "models" / "tabletop.npz"
DAMAGED = "is no relation model that can be read ({}); write it anew with `lifelore learn-relations --out`"


def shipped_model() -> RelationClassifier:
    """The model that comes with the package, trained on simulated tabletop scenes alone."""
    return load_model(SHIPPED)


def save_model(model: RelationClassifier, path: str | Path, about: Mapping[str, Any] | None = None) -> None:
    """Write a fitted model; `about` is for people: how it was trained, as JSON values.

    Raises
    ------
    InputError
        The model is not fitted.
    StoreError
        Nothing can be written there.
    """
    content = model_bytes(model, about)
    try:
        with whole_file(path) as file:
            file.write(content)
    except OSError as error:
        raise StoreError(f"the model cannot be written to {path}: {error.strerror}") from None


def check_model_path(path: str | Path) -> None:
    """Refuse a place that no model can be written to, before hours are spent on one."""
    place = Path(path)
    if place.is_dir() or not place.parent.is_dir():
        what = "is a folder" if place.is_dir() else "lies in a folder that does not exist"
        raise InputError(f"out must be a file to write the model to; {path} {what}")


def load_model(path: str | Path) -> RelationClassifier:
    """The model that `save_model` wrote.

    Raises
    ------
    InputError
        There is no such file, or it is none of ours, newer, or damaged.
    """
    return model_from_bytes(_content(path), str(path))


def model_about(path: str | Path) -> dict[str, Any]:
    """What the model says of itself: how it was trained, its names, its settings."""
    _, header = _opened(_content(path), str(path))
    return header


def _content(path: str | Path) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"the relation model {path} cannot be read: {error.strerror}") from None


def model_bytes(model: RelationClassifier, about: Mapping[str, Any] | None = None) -> bytes:
    """The model as the bytes of an npz file."""
    if not model.models:
        raise InputError("a classifier must be fitted before it is saved; call fit first")
    header: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "method": model.method,
        "adjacent_gap": model.adjacent_gap,
        "multi_label": model.multi_label,
        "names": list(model.names),
        "symmetric": sorted(model.symmetric),
        "settings": asdict(model.settings),
        "about": dict(about or {}),
        "models": {},
    }
    if model.method == "displacement":
        omega = model.neighbours.omega
        header["neighbours"] = {
            "k": int(model.neighbours.k),
            "omega": None if omega is None else float(omega),
            "weights": model.neighbours.weights,
        }
    check_header({**header, "models": {kind: {} for kind in model.models}})
    arrays: dict[str, NDArray[Any]] = {}
    for number, (kind, one) in enumerate(model.models.items()):
        parts, columns = _parts(one)
        header["models"][kind] = {"at": number, **parts}
        arrays.update({f"{number}.{name}": column for name, column in columns.items()})
    text = json.dumps(header, sort_keys=True, allow_nan=False).encode()
    stream = io.BytesIO()
    np.savez_compressed(stream, about=np.frombuffer(text, np.uint8), **arrays)  # type: ignore[arg-type]
    return stream.getvalue()


def _parts(one: TreeRelations | DisplacementRelations) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    if isinstance(one, TreeRelations):
        told = {"classes": list(one.classes), "columns": list(one.columns), "temperature": one.temperature}
        return told, one.trees.arrays()
    told = {"classes": list(one.classes), "k": int(one.k), "weights": one.weights}
    return told, {"displacements": one.displacements, "codes": one.codes}


def model_from_bytes(content: bytes, where: str = "the model") -> RelationClassifier:
    """The model of `model_bytes`; `where` is named when it cannot be read."""
    arrays, header = _opened(content, where)
    try:
        check_header(header)
        model = RelationClassifier(
            header["method"],
            adjacent_gap=header["adjacent_gap"],
            multi_label=header["multi_label"],
            symmetric=header["symmetric"],
            settings=ContactSettings(**{name: float(value) for name, value in header["settings"].items()}),
            **_neighbours(header),
        )
        model.names, model.symmetric = tuple(header["names"]), frozenset(header["symmetric"])
        for kind, told in header["models"].items():
            prefix = f"{told['at']}."
            mine = {name.removeprefix(prefix): a for name, a in arrays.items() if name.startswith(prefix)}
            model.models[kind] = _whole(model, kind, told, mine)
    except KeyError as error:
        raise InputError(f"{where} {DAMAGED.format(f'{error} is missing')}") from None
    except (TypeError, ValueError, AttributeError, OverflowError) as error:
        raise InputError(f"{where} {DAMAGED.format(error)}") from None
    return model


def _neighbours(header: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of the votes; files of the first models tell them of each part alone, and ω not at all."""
    if header["method"] != "displacement":
        return {}
    told = header.get("neighbours")
    if told is None:
        told = {name: next(iter(header["models"].values()))[name] for name in ("k", "weights")}
    return asdict(NeighbourSettings(**told))


def _whole(
    model: RelationClassifier, kind: str, told: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
) -> TreeRelations | DisplacementRelations:
    check_classes(kind, told["classes"], model.words, model.multi_label)
    classes = tuple(told["classes"])
    if model.method == "trees":
        trees = TreeEnsemble.from_arrays(arrays)
        check_trees(kind, told, trees.n_classes, trees.n_features, model.words, model.multi_label)
        return TreeRelations(classes, tuple(told["columns"]), trees, float(told["temperature"]))
    check_displacements(arrays["displacements"], arrays["codes"], classes)
    votes = NeighbourSettings(told["k"], None, told["weights"])
    return DisplacementRelations(classes, arrays["displacements"], arrays["codes"], votes.k, votes.weights)


def _opened(content: bytes, where: str) -> tuple[dict[str, NDArray[Any]], dict[str, Any]]:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as packed:
            if sum(entry.file_size for entry in packed.infolist()) > LARGEST:
                raise ValueError(f"it unpacks to more than {LARGEST} bytes")
        with np.load(io.BytesIO(content), allow_pickle=False) as packed:
            arrays = {name: packed[name] for name in packed.files}
        header = json.loads(arrays.pop("about").tobytes())
        if header["format"] != FORMAT:
            raise ValueError("another kind of file")
    except Exception as error:  # a damaged archive raises what its parsers raise: zlib, lzma, struct, tokenize, …
        raise InputError(f"{where} {DAMAGED.format(error)}") from None
    if header.get("version") != VERSION:
        raise InputError(f"{where} has version {header.get('version')}, this Lifelore reads {VERSION}; update it")
    return arrays, header
