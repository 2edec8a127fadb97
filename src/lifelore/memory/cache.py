"""The cache of merged records that `Memory.recall` reads, updated by additive upserts."""

import json
from collections.abc import Iterable
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory import ledger
from lifelore.memory.connection import Connection
from lifelore.memory.folding import Folded, LoreKey, fold, require_one_merge
from lifelore.memory.record_rules import described

_ROWS_AT_ONCE = 10_000
EVERY_SLOT = -(2**63), 2**63 - 1

# "The contribution of the new row is later than that of the row in place."
_LATER = """EXISTS (
    SELECT 1 FROM lifelore_contributions AS new, lifelore_contributions AS old
    WHERE new.number = excluded.origin AND old.number = {table}.origin
    AND (new.stamp, new.robot, new.process, new.seq) > (old.stamp, old.robot, old.process, old.seq))"""

_NOTE = (
    "INSERT INTO lifelore_lore (kind, key, version, merge, about, origin)"
    " VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT (kind, key, version)"
    " DO UPDATE SET about = excluded.about, origin = excluded.origin"
    f" WHERE {_LATER.format(table='lifelore_lore')}"
)
_CELLS = (
    "INSERT INTO lifelore_cells (lore, slot, value, origin) VALUES (?, ?, ?, ?)"
    " ON CONFLICT (lore, slot) DO UPDATE SET "
)
_UPSERT = {
    "add": _CELLS + "value = lifelore_cells.value + excluded.value",
    "union": _CELLS + "value = excluded.value WHERE excluded.value > lifelore_cells.value",
    "newest": (
        _CELLS + f"value = excluded.value, origin = excluded.origin WHERE {_LATER.format(table='lifelore_cells')}"
    ),
}
_MENTION = "INSERT INTO lifelore_mentions (contribution, lore) VALUES (?, ?)"
_MENTIONS = "SELECT contribution FROM lifelore_mentions WHERE lore = ?"
_NAMED = "kind = ? AND key = ? AND version = ?"
_FIND = f"SELECT number, merge, about FROM lifelore_lore WHERE {_NAMED}"
_READ = "SELECT slot, value FROM lifelore_cells WHERE lore = ? AND slot BETWEEN ? AND ? ORDER BY slot"


def write(conn: Connection, folded: dict[LoreKey, Folded]) -> None:
    """Merge folded contributions of any age into the cache; the ledger must hold them already."""
    for name, part in sorted(folded.items()):
        conn.execute(_NOTE, (*name, part.merge, described(part.about), part.origin))
        lore, merge, _ = conn.execute(_FIND, name).fetchone()
        require_one_merge(name, {merge, part.merge})
        conn.execute_many(_MENTION, [(number, lore) for number in part.mentions])
        _write_cells(conn, lore, part)


def _columns(cells: Iterable[tuple[int, int]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    table = np.fromiter(chain.from_iterable(cells), np.int64).reshape(-1, 2)
    return np.ascontiguousarray(table[:, 0]), np.ascontiguousarray(table[:, 1])


def _write_cells(conn: Connection, lore: int, part: Folded) -> None:
    """Upsert the cells of a key. Only *newest* needs the origin of a value; the other merges store 0."""
    origins = part.origins if part.merge == "newest" else np.zeros_like(part.origins)
    slots, values = part.slots.tolist(), part.values.tolist()
    rows = list(zip([lore] * len(slots), slots, values, origins.tolist(), strict=True))
    for batch in ledger.in_batches(rows, _ROWS_AT_ONCE):
        conn.execute_many(_UPSERT[part.merge], batch)


def read(conn: Connection, name: LoreKey, within: tuple[int, int] = EVERY_SLOT) -> Record | None:
    """One key's merged record, slots ascending; None when no contribution has the key.

    within : first and last slot to read
    """
    found = conn.first(_FIND, name)
    if found is None:
        return None
    lore, merge, about = found
    return Record(*name, merge, *_columns(conn.execute(_READ, (lore, *within))), json.loads(about))


def names(conn: Connection, kind: str) -> list[tuple[str, int, dict]]:
    """(key, version, about) of every key of a kind, sorted."""
    rows = conn.execute("SELECT key, version, about FROM lifelore_lore WHERE kind = ?", (kind,))
    return sorted(((row[0], row[1], json.loads(row[2])) for row in rows), key=lambda row: row[:2])


def mentioned(conn: Connection, contributions: Iterable[int]) -> set[LoreKey]:
    """The keys of these contributions."""
    query = (
        "SELECT kind, key, version FROM lifelore_lore JOIN lifelore_mentions"
        " ON lore = lifelore_lore.number WHERE contribution = ?"
    )
    return {(row[0], row[1], row[2]) for number in contributions for row in conn.execute(query, (number,))}


def mentions(conn: Connection, name: LoreKey) -> set[int]:
    """Row numbers of the contributions that have a record of this key."""
    found = conn.first(_FIND, name)
    return set() if found is None else mentions_of(conn, found[0])


def mentions_of(conn: Connection, lore: int) -> set[int]:
    """`mentions` by the number of the key."""
    return {row[0] for row in conn.execute(_MENTIONS, (lore,))}


def rebuild(conn: Connection, only: set[LoreKey] | None = None) -> None:
    """Delete the cache, of the keys in `only` or of all keys, and compute it again from the contributions."""
    if only is None:
        for table in ("cells", "mentions", "lore"):
            conn.execute(f"DELETE FROM lifelore_{table}")
        touched = None
    else:
        touched = _clear(conn, only)
    oldest_first = [entry.number for entry in ledger.entries(conn) if touched is None or entry.number in touched]
    write(conn, fold(ledger.load(conn, oldest_first), only))


def _clear(conn: Connection, only: set[LoreKey]) -> set[int]:
    """Delete the cache of some keys; return the row numbers of their contributions."""
    numbers: set[int] = set()
    for name in sorted(only):
        if (found := conn.first(_FIND, name)) is None:
            raise StoreError(f"cache of {name[0]}/{name[1]} version {name[2]} is missing; rebuild the memory")
        lore = found[:1]
        numbers |= mentions_of(conn, found[0])
        conn.execute("DELETE FROM lifelore_cells WHERE lore = ?", lore)
        conn.execute("DELETE FROM lifelore_mentions WHERE lore = ?", lore)
        conn.execute("DELETE FROM lifelore_lore WHERE number = ?", lore)
    return numbers
