"""Checks records and names before memory stores them."""

import json
import operator
from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.protocols import Merge, Record

LONGEST_NAME = 200
MERGES: tuple[str, ...] = get_args(Merge)
LARGEST = 2**63 - 1
_sorted = json.JSONEncoder(sort_keys=True).encode
_canonical = json.JSONEncoder(sort_keys=True, allow_nan=False, separators=(",", ":")).encode


def is_name(name: Any) -> bool:
    """Whether `name` is printable text of 1 to 200 characters, which both databases can store."""
    return isinstance(name, str) and 0 < len(name) <= LONGEST_NAME and name.isprintable()


def check_name(argument: str, name: str) -> str:
    """Return `name` if it is one, by `is_name`."""
    if not is_name(name):
        raise InputError(
            f"{argument} must be 1 to {LONGEST_NAME} printable characters, got {str(name)[:60]!r}; rename it"
        )
    return name


def check_whole(argument: str, number: Any, smallest: int = 0) -> int:
    """`number` as a Python int between `smallest` and 2**63 - 1."""
    try:
        whole = operator.index(number)
    except TypeError:
        whole = None
    if whole is None or isinstance(number, bool) or not smallest <= whole <= LARGEST:
        raise InputError(f"{argument} must be a whole number from {smallest} to 2**63 - 1, got {number!r}")
    return whole


def canonical_json(argument: str, about: Mapping[str, Any]) -> str:
    """The canonical JSON text of a mapping: sorted keys, ASCII, no NaN."""
    try:
        return _canonical(dict(about))
    except (TypeError, ValueError) as error:
        raise InputError(f"{argument} must hold plain JSON values, but {error}; convert it first") from error


def described(about: Mapping[str, Any]) -> str:
    """The JSON text of a checked description as the cache has it."""
    return _sorted(dict(about))


def checked_records(records: Sequence[Record]) -> list[Record]:
    """The records with int64 arrays sorted by slot, each (kind, key, version) at most once."""
    checked = [checked_record(record) for record in records]
    names = [(record.kind, record.key, record.version) for record in checked]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"records must differ in (kind, key, version), got {name} twice; join them first")
    return checked


def checked_record(record: Record) -> Record:
    """A checked record with its arrays sorted by slot."""
    where = f"record {record.kind}/{record.key}"
    check_name("record.kind", record.kind)
    check_name("record.key", record.key)
    version = check_whole(f"{where}: version", record.version)
    if record.merge not in MERGES:
        raise InputError(f"{where}: merge must be one of {', '.join(MERGES)}, got {record.merge!r}")
    slots, values = _column(where, "slots", record.slots), _column(where, "values", record.values)
    if slots.shape != values.shape:
        raise InputError(f"{where}: slots and values must be equally long, got {slots.size} and {values.size}")
    if not (slots[1:] > slots[:-1]).all():
        ascending = np.argsort(slots, kind="stable")
        slots, values = slots[ascending], values[ascending]
        if np.any(slots[1:] == slots[:-1]):
            raise InputError(f"{where}: slots must be unique within a record; add up repeated slots first")
    about = json.loads(canonical_json(f"{where}: about", record.about))
    return Record(record.kind, record.key, version, record.merge, slots, values, about)


def _column(where: str, name: str, column: Any) -> NDArray[np.int64]:
    array = np.asarray(column)
    whole = array.dtype == np.int64 or (array.dtype.kind in "iu" and np.can_cast(array.dtype, np.int64))
    if array.ndim != 1 or (array.size and not whole):
        got = f"shape {array.shape} of {array.dtype}"
        raise InputError(f"{where}: {name} must be a one-dimensional int64 array, got {got}; convert it first")
    return array.astype(np.int64)
