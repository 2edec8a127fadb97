"""Checks of a relation model from a file, so that its predictions can neither fail nor hang.

A file may be damaged or of unknown origin: every number is checked once, on loading. All functions raise
InputError without the name of the file; the reader adds it.
"""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.pairs import gap_rule
from lifelore.perception.pairs.directed_label import REVERSED, mirrored
from lifelore.perception.pairs.pair_features import COLUMNS
from lifelore.perception.relations.label_relations import NO, ON_TABLE, YES
from lifelore.perception.relations.relation_classifier import OBJECTS, WITH_TABLE
from lifelore.perception.trees.tree_relations import CARRIED, Vocabulary, carried_columns, inner_symmetric

LEAST_LENGTH, LARGEST_LENGTH, LARGEST_NUMBER = 1e-4, 100.0, 1e6
"""Least and largest length, metres, and largest other setting: beyond them sums overflow or searches never end."""
TEMPERATURES = 0.05, 20.0


def check_header(header: Mapping[str, Any]) -> None:
    """Check that all header fields exist with the right types, names and ranges."""
    kinds = {
        "method": str,
        "multi_label": bool,
        "names": list,
        "symmetric": list,
        "settings": dict,
        "models": dict,
    }
    for name, kind in kinds.items():
        if not isinstance(header.get(name), kind):
            raise InputError(f"{name} must be a {kind.__name__}, got {header.get(name)!r:.60}")
    if header.get("adjacent_gap", "nothing") is not None and not is_number(header.get("adjacent_gap")):
        raise InputError(f"adjacent_gap must be a number or null, got {header.get('adjacent_gap')!r:.60}")
    for name in ("names", "symmetric"):
        _check_words(name, header[name])
    if odd := [name for name in header["names"] if name.startswith(REVERSED) or name.endswith("=")]:
        raise InputError(f"names must neither start with ~ nor end with =, got {odd!r:.60}")
    for name, value in header["settings"].items():
        _check_setting(name, value)
    if not header["models"] or not all(isinstance(fields, dict) for fields in header["models"].values()):
        raise InputError("models must be described, at least one")


def is_number(value: Any) -> bool:
    """Whether a value of JSON is a finite number."""
    return (
        isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300 and isfinite(value)
    )


def _check_words(name: str, words: Any) -> None:
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise InputError(f"{name} must be words, got {words!r:.60}")
    if len(set(words)) < len(words):
        raise InputError(f"{name} must differ, got {words!r:.60}")


def _check_setting(name: str, value: Any) -> None:
    if name == "as_printed":
        if not isinstance(value, bool):
            raise InputError(f"the setting {name} must be true or false, got {value!r:.60}")
        return
    if not is_number(value):
        raise InputError(f"the setting {name} must be a number, got {value!r:.60}")
    length = name not in ("cost", "wide_cost", "min_support")
    least = LEAST_LENGTH if length and not (name == "voxel" and value == 0) else 0.0
    most = LARGEST_LENGTH if length else LARGEST_NUMBER
    if not least <= value <= most:
        raise InputError(f"the setting {name} must be from {least:g} to {most:g}, got {value!r:.60}")


def check_classes(kind: str, classes: Any, vocabulary: Vocabulary, multi_label: bool) -> None:
    """Check that a part's classes are names of the vocabulary, or yes and no."""
    _check_words(f"classes of {kind}", classes)
    if multi_label:
        name = kind.removeprefix(ON_TABLE)
        known = name.removeprefix(REVERSED) if kind.startswith(ON_TABLE) else name
        if known not in vocabulary.names or not classes or not set(classes) <= {NO, YES}:
            raise InputError(f"the model of {kind!r:.60} must say {NO} or {YES} of a word that is learnt")
        return
    if kind not in (OBJECTS, WITH_TABLE):
        raise InputError(f"models must be called {OBJECTS} and {WITH_TABLE}, got {kind!r:.60}")
    beside = {gap_rule.BESIDE} if kind == OBJECTS and vocabulary.adjacent_gap is not None else set()
    strange = {name.removeprefix(REVERSED) for name in classes} - set(vocabulary.names) - beside
    if strange or not classes:
        raise InputError(f"classes of {kind} must be words that are learnt, got {sorted(strange)!r:.60}")


def check_trees(
    kind: str,
    fields: Mapping[str, Any],
    n_classes: int,
    n_features: int,
    vocabulary: Vocabulary,
    multi_label: bool,
) -> None:
    """Check that the header fields of trees fit the trees and the features."""
    classes, columns, temperature = fields["classes"], fields["columns"], fields["temperature"]
    if len(classes) != n_classes or not isinstance(columns, list) or len(columns) != n_features:
        raise InputError("names and trees do not fit together")
    if not is_number(temperature) or not TEMPERATURES[0] <= temperature <= TEMPERATURES[1]:
        raise InputError(
            f"temperature must be from {TEMPERATURES[0]} to {TEMPERATURES[1]}, got {temperature!r:.60}"
        )
    if kind == OBJECTS and not multi_label:
        symmetric = inner_symmetric(vocabulary.symmetric)
        if not {mirrored(name, symmetric) for name in classes} <= set(classes):
            raise InputError("classes of objects must be those of both orders")
    carried = (
        carried_columns(vocabulary.names, vocabulary.symmetric) if kind == WITH_TABLE and not multi_label else ()
    )
    own = columns[: len(columns) - len(carried)]
    if tuple(columns[len(own) :]) != carried or not set(map(str, own)) <= set(COLUMNS):
        unknown = [name for name in columns if name not in COLUMNS and not str(name).startswith(CARRIED)]
        raise InputError(f"columns of {kind!r:.60} must be features that are measured, got {unknown!r:.60}")


def check_displacements(displacements: NDArray[Any], codes: NDArray[Any], classes: Sequence[str]) -> None:
    """Check that displacements are finite rows of three, with codes of existing classes."""
    fit = displacements.ndim == 2 and displacements.shape == (codes.size, 3) and codes.ndim == 1 and codes.size
    if not fit or displacements.dtype.kind != "f" or codes.dtype.kind != "i":
        raise InputError("displacements must be three columns of numbers, and have a whole number as code each")
    if not (np.abs(displacements) <= LARGEST_LENGTH).all():
        raise InputError(f"displacements must be finite and at most {LARGEST_LENGTH:g} m")
    if codes.min() < 0 or codes.max() >= len(classes):
        raise InputError("codes of displacements must be of classes that there are")
