"""Relation models as npz files of arrays and a JSON header: read, checked and written without pickle.

Equal models give equal bytes.
"""

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.atomic_write import atomic_write
from lifelore.core.errors import InputError, StoreError
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.relations.displacement_relations import DisplacementRelations, NeighbourSettings
from lifelore.perception.relations.relation_model import RelationModel
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
"""Largest size of a model after unpacking, in bytes, so that no file fills the memory."""
SHIPPED = Path(__file__).parent / "models" / "tabletop.npz"
DAMAGED = "is no relation model that can be read ({}); write it anew with `lifelore learn-relations --out`"


def write_model(model: RelationModel, path: str | Path, about: Mapping[str, Any] | None = None) -> None:
    """Write a model; `about` holds notes for people, such as how it was trained, as JSON values.

    Raises
    ------
    InputError
        A value of the model cannot be read back.
    StoreError
        The disk refuses.
    """
    content = model_bytes(model, about)
    try:
        with atomic_write(path) as file:
            file.write(content)
    except OSError as error:
        raise StoreError(f"the model cannot be written to {path}: {error.strerror}") from None


def check_model_path(path: str | Path) -> None:
    """Raise InputError for a path that no model can be written to, before hours of training."""
    place = Path(path)
    if place.is_dir() or not place.parent.is_dir():
        reason = "is a folder" if place.is_dir() else "lies in a folder that does not exist"
        raise InputError(f"out must be a file to write the model to; {path} {reason}")


def read_model(path: str | Path) -> RelationModel:
    """The model that `write_model` wrote.

    Raises
    ------
    InputError
        There is no such file, or it is none of ours, newer, or damaged.
    """
    return model_from_bytes(_content(path), str(path))


def model_about(path: str | Path) -> dict[str, Any]:
    """The header of a model file: how the model was trained, its names, its settings."""
    _, header = _opened(_content(path), str(path))
    return header


def _content(path: str | Path) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"the relation model {path} cannot be read: {error.strerror}") from None


def model_bytes(model: RelationModel, about: Mapping[str, Any] | None = None) -> bytes:
    """The model as the bytes of an npz file."""
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
    for number, (kind, part) in enumerate(model.models.items()):
        fields, columns = _fields(part)
        header["models"][kind] = {"at": number, **fields}
        arrays.update({f"{number}.{name}": column for name, column in columns.items()})
    text = json.dumps(header, sort_keys=True, allow_nan=False).encode()
    stream = io.BytesIO()
    np.savez_compressed(stream, about=np.frombuffer(text, np.uint8), **arrays)  # type: ignore[arg-type]
    return stream.getvalue()


def _fields(part: TreeRelations | DisplacementRelations) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header fields and arrays of one part of a model."""
    if isinstance(part, TreeRelations):
        fields = {"classes": list(part.classes), "columns": list(part.columns), "temperature": part.temperature}
        return fields, part.trees.arrays()
    fields = {"classes": list(part.classes), "k": int(part.k), "weights": part.weights}
    return fields, {"displacements": part.displacements, "codes": part.codes}


def model_from_bytes(content: bytes, where: str = "the model") -> RelationModel:
    """The model of `model_bytes`; errors name `where`."""
    arrays, header = _opened(content, where)
    try:
        check_header(header)
        model = RelationModel(
            header["method"],
            header["adjacent_gap"],
            header["multi_label"],
            _contact_settings(header["settings"]),
            _neighbours(header),
            tuple(header["names"]),
            frozenset(header["symmetric"]),
            {},
        )
        models = {kind: _part(model, kind, fields, arrays) for kind, fields in header["models"].items()}
    except KeyError as error:
        raise InputError(f"{where} {DAMAGED.format(f'{error} is missing')}") from None
    except (TypeError, ValueError, AttributeError, OverflowError) as error:
        raise InputError(f"{where} {DAMAGED.format(error)}") from None
    return replace(model, models=models)


def _contact_settings(settings: Mapping[str, Any]) -> ContactSettings:
    """Settings from a header; numbers may be whole."""
    numbers = {name: float(value) for name, value in settings.items() if not isinstance(value, bool)}
    return ContactSettings(**{**settings, **numbers})


def _neighbours(header: Mapping[str, Any]) -> NeighbourSettings:
    """Settings of the nearest neighbours; files of the first models have `k` and `weights` in each part, no ω."""
    if header["method"] != "displacement":
        return NeighbourSettings()
    fields = header.get("neighbours")
    if fields is None:
        fields = {name: next(iter(header["models"].values()))[name] for name in ("k", "weights")}
    return NeighbourSettings(**fields)


def _part(
    model: RelationModel, kind: str, fields: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
) -> TreeRelations | DisplacementRelations:
    """One part of a model from its header fields and its arrays, checked."""
    prefix = f"{fields['at']}."
    own = {name.removeprefix(prefix): array for name, array in arrays.items() if name.startswith(prefix)}
    check_classes(kind, fields["classes"], model.vocabulary, model.multi_label)
    classes = tuple(fields["classes"])
    if model.method == "trees":
        trees = TreeEnsemble.from_arrays(own)
        check_trees(kind, fields, trees.n_classes, trees.n_features, model.vocabulary, model.multi_label)
        return TreeRelations(classes, tuple(fields["columns"]), trees, float(fields["temperature"]))
    check_displacements(own["displacements"], own["codes"], classes)
    votes = NeighbourSettings(fields["k"], None, fields["weights"])
    return DisplacementRelations(classes, own["displacements"], own["codes"], votes.k, votes.weights)


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
