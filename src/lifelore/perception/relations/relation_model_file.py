"""Relation models as npz files of arrays and a JSON header: read, checked and written without pickle.

Equal models give equal bytes.
"""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from lifelore.core.atomic_write import write_file
from lifelore.core.errors import InputError
from lifelore.core.packed_arrays import PackedFormat
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

FORMAT = PackedFormat(
    "lifelore relation model", 1, "relation model", "`lifelore learn-relations --out`", largest=2**28
)
SUFFIX = ".npz"
"""End of the name of every relation model file."""


def write_model(model: RelationClassifier, path: str | Path, about: Mapping[str, Any] | None = None) -> None:
    """Write a model; `about` holds notes for people, such as how it was trained, as JSON values.

    Raises
    ------
    InputError
        A value of the model cannot be read back.
    StoreError
        The disk refuses.
    """
    write_file(path, model_bytes(model, about), "the model")


def check_model_path(path: str | Path) -> None:
    """Raise InputError for a path that no model can be written to, before hours of training."""
    place = Path(path)
    if place.is_dir() or not place.parent.is_dir():
        reason = "is a folder" if place.is_dir() else "lies in a folder that does not exist"
        raise InputError(f"out must be a file to write the model to; {path} {reason}")


def read_model(path: str | Path) -> RelationClassifier:
    """The model that `write_model` wrote.

    Raises
    ------
    InputError
        There is no such file, or it is none of ours, newer, or damaged.
    """
    return model_from_bytes(_content(path), str(path))


def model_about(path: str | Path) -> dict[str, Any]:
    """The header of a model file: how the model was trained, its names, its settings."""
    return FORMAT.unpack(_content(path), str(path))[0]


def _content(path: str | Path) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"the relation model {path} cannot be read: {error.strerror}") from None


def model_bytes(model: RelationClassifier, about: Mapping[str, Any] | None = None) -> bytes:
    """The model as the bytes of an npz file.

    Raises
    ------
    InputError
        The classifier is not fitted, or a value of it cannot be read back.
    """
    if not model.models_:
        raise InputError("a classifier must be fitted before it is saved; call fit first")
    header: dict[str, Any] = {
        "method": model.method,
        "adjacent_gap": model.adjacent_gap,
        "multi_label": model.multi_label,
        "names": list(model.names_),
        "symmetric": sorted(model.symmetric_),
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
    check_header({**header, "models": {kind: {} for kind in model.models_}})
    arrays: dict[str, NDArray[Any]] = {}
    for number, (kind, part) in enumerate(model.models_.items()):
        fields, columns = _fields(part)
        header["models"][kind] = {"at": number, **fields}
        arrays.update({f"{number}.{name}": column for name, column in columns.items()})
    return FORMAT.pack(header, arrays)


def _fields(part: TreeRelations | DisplacementRelations) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header fields and arrays of one part of a model."""
    if isinstance(part, TreeRelations):
        fields = {"classes": list(part.classes), "columns": list(part.columns), "temperature": part.temperature}
        return fields, part.trees.arrays()
    fields = {"classes": list(part.classes), "k": int(part.k), "weights": part.weights}
    return fields, {"displacements": part.displacements, "codes": part.codes}


def model_from_bytes(content: bytes, where: str = "the model") -> RelationClassifier:
    """The model of `model_bytes`; errors name `where`."""
    header, arrays = FORMAT.unpack(content, where)
    try:
        check_header(header)
        model = RelationClassifier(
            header["method"],
            adjacent_gap=header["adjacent_gap"],
            multi_label=header["multi_label"],
            symmetric=frozenset(header["symmetric"]),
            settings=_contact_settings(header["settings"]),
            **_neighbours(header),
        )
        model.names_, model.symmetric_ = tuple(header["names"]), frozenset(header["symmetric"])
        model.models_ = {kind: _part(model, kind, fields, arrays) for kind, fields in header["models"].items()}
    except KeyError as error:
        raise FORMAT.damaged(where, ValueError(f"{error} is missing")) from None
    except (TypeError, ValueError, AttributeError, OverflowError) as error:
        raise FORMAT.damaged(where, error) from None
    return model


def _contact_settings(settings: Mapping[str, Any]) -> ContactSettings:
    """Settings from a header; numbers may be whole."""
    numbers = {name: float(value) for name, value in settings.items() if not isinstance(value, bool)}
    return ContactSettings(**{**settings, **numbers})


def _neighbours(header: Mapping[str, Any]) -> Mapping[str, Any]:
    """Settings of the nearest neighbours; files of the first models have `k` and `weights` in each part, no ω."""
    if header["method"] != "displacement":
        return {}
    fields = header.get("neighbours")
    if fields is None:
        fields = {name: next(iter(header["models"].values()))[name] for name in ("k", "weights")}
    return fields


def _part(
    model: RelationClassifier, kind: str, fields: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
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
