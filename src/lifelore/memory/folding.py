"""Folds the records of many contributions into one array of cells per key.

*add* sums the values of a cell, *union* takes the largest value, *newest* the last. Folding is associative: given
oldest first, contributions give the same cells in any grouping.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Merge, Record
from lifelore.memory.contribution import Contribution, LoreKey

Ints = NDArray[np.int64]
# Records folded at a time: more need more memory, fewer need more time for repeated sorting.
_AT_A_TIME = 64


@dataclass(frozen=True)
class Stored:
    """A contribution and the number of its row in one memory."""

    number: int
    contribution: Contribution


@dataclass(frozen=True)
class Folded:
    """The merged cells of one key over some contributions.

    Parameters
    ----------
    slots, values, origins : (n,) int64
        Cells ascending by slot; `origins` is the row number of the last contribution to the cell.
    about, origin : mapping, int
        The newest description and the row number of its contribution.
    mentions : list of int
        Row numbers of all contributions that have this key.
    """

    merge: Merge
    slots: Ints
    values: Ints
    origins: Ints
    about: Any
    origin: int
    mentions: list[int] = field(default_factory=list)


def fold(stored: Iterable[Stored], only: set[LoreKey] | None = None) -> dict[LoreKey, Folded]:
    """Fold contributions, given oldest first, into one `Folded` per key.

    Parameters
    ----------
    stored : iterable of Stored
        Ascending in `Contribution.order`.
    only : set of (kind, key, version), optional
        Fold only these keys.

    Raises
    ------
    StoreError
        A damaged contribution; two contributions that merge one key differently; a sum beyond 64 bits.
    """
    waiting: dict[LoreKey, list[Folded]] = {}
    for one in stored:
        for record in one.contribution.records():
            name = (record.kind, record.key, record.version)
            if only is None or name in only:
                parts = waiting.setdefault(name, [])
                if parts:
                    require_one_merge(name, {parts[0].merge, record.merge})
                parts.append(_lift(one.number, record))
                if len(parts) > _AT_A_TIME:
                    waiting[name] = [_join(name, parts)]
    return {name: _join(name, parts) for name, parts in sorted(waiting.items())}


def lift(number: int, records: Iterable[Record]) -> dict[LoreKey, Folded]:
    """The records of a single contribution in row `number` as `fold` gives them; records are checked."""
    return {(record.kind, record.key, record.version): _lift(number, record) for record in records}


def _lift(number: int, record: Record) -> Folded:
    origins = np.full(record.slots.size, number, dtype=np.int64)
    return Folded(record.merge, record.slots, record.values, origins, record.about, number, [number])


def _join(name: LoreKey, parts: list[Folded]) -> Folded:
    merge = parts[0].merge
    if len(parts) == 1:
        return parts[0]
    slots = np.concatenate([part.slots for part in parts])
    oldest_first = np.argsort(slots, kind="stable")
    slots = slots[oldest_first]
    values = np.concatenate([part.values for part in parts])[oldest_first]
    origins = np.concatenate([part.origins for part in parts])[oldest_first]
    starts = np.flatnonzero(np.diff(slots, prepend=slots[:1] - 1)) if slots.size else slots
    last = np.append(starts[1:], slots.size)[: starts.size] - 1
    return Folded(
        merge, slots[starts], _reduce(name, merge, values, starts, last), origins[last],
        parts[-1].about, parts[-1].origin, [number for part in parts for number in part.mentions],
    )  # fmt: skip


def _reduce(name: LoreKey, merge: Merge, values: Ints, starts: Ints, last: Ints) -> Ints:
    if merge == "newest" or not starts.size:
        return values[last]
    if merge == "union":
        return np.maximum.reduceat(values, starts)
    return _exact_sums(name, values, starts)


def _exact_sums(name: LoreKey, values: Ints, starts: Ints) -> Ints:
    """Sums of runs by 32-bit halves, so that only a total beyond 64 bits fails, never a partial sum."""
    low = np.add.reduceat(values & 0xFFFFFFFF, starts)
    high = np.add.reduceat(values >> 32, starts) + (low >> 32)
    if np.any(high != high.astype(np.int32)):
        raise StoreError(too_large(f"{name[0]}/{name[1]}"))
    return (high << 32) | (low & 0xFFFFFFFF)


def too_large(key: str) -> str:
    """The error message for a sum beyond 64 bits."""
    return f"a value of {key} would no longer fit 64 bits; nothing was changed, contribute smaller weights"


def require_one_merge(name: LoreKey, merges: set[str]) -> None:
    """StoreError unless all contributions merge a key in the same way."""
    if len(merges) > 1:
        raise StoreError(
            f"{name[0]}/{name[1]} version {name[2]} is merged by {' and by '.join(sorted(merges))};"
            " one key has one merge, so raise the record's version where it changed; nothing was changed"
        )
