"""The cache of merged records that `Memory.recall` reads, updated by additive upserts."""

import json
from collections.abc import Iterable
from itertools import chain
from typing import Any

import numpy as np
from sqlalchemy import Connection, text

from lifelore.core.protocols import Record
from lifelore.memory import ledger
from lifelore.memory.folding import Folded, LoreKey, fold, require_one_merge

_ROWS_AT_ONCE = 10_000

# "The contribution of the new row is later than that of the row in place."
_LATER = """EXISTS (
    SELECT 1 FROM lifelore_contributions AS new, lifelore_contributions AS old
    WHERE new.number = excluded.origin AND old.number = {table}.origin
    AND (new.stamp, new.robot, new.process, new.seq) > (old.stamp, old.robot, old.process, old.seq))"""

_NOTE = text(
    "INSERT INTO lifelore_lore (kind, key, version, merge, about, origin)"
    " VALUES (:kind, :key, :version, :merge, :about, :origin) ON CONFLICT (kind, key, version)"
    " DO UPDATE SET about = excluded.about, origin = excluded.origin"
    f" WHERE {_LATER.format(table='lifelore_lore')}"
)
_CELL = (
    "INSERT INTO lifelore_cells (lore, slot, value, origin) VALUES (:lore, :slot, :value, :origin)"
    " ON CONFLICT (lore, slot) DO UPDATE SET "
)
_UPSERT = {
    "add": text(_CELL + "value = lifelore_cells.value + excluded.value"),
    "union": text(_CELL + "value = excluded.value WHERE excluded.value > lifelore_cells.value"),
    "newest": text(
        _CELL + f"value = excluded.value, origin = excluded.origin WHERE {_LATER.format(table='lifelore_cells')}"
    ),
}
_MENTION = text("INSERT INTO lifelore_mentions (contribution, lore) VALUES (:contribution, :lore)")
_FIND = text(
    "SELECT number, merge, about FROM lifelore_lore WHERE kind = :kind AND key = :key AND version = :version"
)


def write(conn: Connection, folded: dict[LoreKey, Folded]) -> None:
    """Merge folded contributions into the cache; the ledger must hold them already."""
    for name, part in sorted(folded.items()):
        named = _named(name)
        about = json.dumps(part.about, sort_keys=True)
        conn.execute(_NOTE, {**named, "merge": part.merge, "about": about, "origin": part.origin})
        lore, merge, _ = conn.execute(_FIND, named).one()
        require_one_merge(name, {merge, part.merge})
        conn.execute(_MENTION, [{"contribution": number, "lore": lore} for number in part.mentions])
        _write_cells(conn, lore, part)


def _write_cells(conn: Connection, lore: int, part: Folded) -> None:
    """Upsert the cells of a key. Only *newest* needs the origin of a value; the other merges store 0.

    The rows go directly to the driver: a building has a million cells, and SQLAlchemy needs more time to prepare
    their parameters than the database needs to store them.
    """
    origins = part.origins if part.merge == "newest" else np.zeros_like(part.origins)
    upsert: Any = _UPSERT[part.merge].compile(dialect=conn.dialect)
    columns = {"slot": part.slots.tolist(), "value": part.values.tolist(), "origin": origins.tolist()}
    columns["lore"] = [lore] * len(origins)
    names = upsert.positiontup if upsert.positional else list(columns)
    rows: Iterable = zip(*(columns[name] for name in names), strict=True)
    if not upsert.positional:
        rows = (dict(zip(names, row, strict=True)) for row in rows)
    for batch in ledger.in_batches(rows, _ROWS_AT_ONCE):
        conn.exec_driver_sql(str(upsert), batch)


def read(conn: Connection, name: LoreKey) -> Record | None:
    """One key's merged record, slots ascending; None when no contribution has the key."""
    found = conn.execute(_FIND, _named(name)).one_or_none()
    if found is None:
        return None
    cells = conn.execute(
        text("SELECT slot, value FROM lifelore_cells WHERE lore = :lore ORDER BY slot"),
        {"lore": found.number},
    )
    table = np.fromiter(chain.from_iterable(cells), np.int64).reshape(-1, 2)
    slots, values = np.ascontiguousarray(table[:, 0]), np.ascontiguousarray(table[:, 1])
    return Record(*name, found.merge, slots, values, json.loads(found.about))


def names(conn: Connection, kind: str) -> list[tuple[str, int, dict]]:
    """(key, version, about) of every key of a kind, sorted."""
    rows = conn.execute(text("SELECT key, version, about FROM lifelore_lore WHERE kind = :kind"), {"kind": kind})
    return sorted(((row[0], row[1], json.loads(row[2])) for row in rows), key=lambda row: row[:2])


def mentioned(conn: Connection, contributions: Iterable[int]) -> set[LoreKey]:
    """The keys of these contributions."""
    query = text(
        "SELECT kind, key, version FROM lifelore_lore JOIN lifelore_mentions"
        " ON lore = lifelore_lore.number WHERE contribution = :contribution"
    )
    found = (conn.execute(query, {"contribution": number}) for number in contributions)
    return {(row[0], row[1], row[2]) for rows in found for row in rows}


def mentions(conn: Connection, name: LoreKey) -> set[int]:
    """Row numbers of the contributions that have a record of this key."""
    found = conn.execute(_FIND, _named(name)).one_or_none()
    if found is None:
        return set()
    query = text("SELECT contribution FROM lifelore_mentions WHERE lore = :lore")
    return set(conn.execute(query, {"lore": found.number}).scalars())


def rebuild(conn: Connection, only: set[LoreKey] | None = None) -> None:
    """Delete the cache, of the keys in `only` or of all keys, and compute it again from the contributions."""
    if only is None:
        for table in ("cells", "mentions", "lore"):
            conn.execute(text(f"DELETE FROM lifelore_{table}"))
        touched = None
    else:
        touched = _clear(conn, only)
    oldest_first = [entry.number for entry in ledger.entries(conn) if touched is None or entry.number in touched]
    write(conn, fold(ledger.load(conn, oldest_first), only))


def _clear(conn: Connection, only: set[LoreKey]) -> set[int]:
    """Delete the cache of some keys; return the row numbers of their contributions."""
    numbers: set[int] = set()
    for name in sorted(only):
        lore = {"lore": conn.execute(_FIND, _named(name)).one().number}
        numbers.update(
            conn.execute(text("SELECT contribution FROM lifelore_mentions WHERE lore = :lore"), lore).scalars()
        )
        conn.execute(text("DELETE FROM lifelore_cells WHERE lore = :lore"), lore)
        conn.execute(text("DELETE FROM lifelore_mentions WHERE lore = :lore"), lore)
        conn.execute(text("DELETE FROM lifelore_lore WHERE number = :lore"), lore)
    return numbers


def _named(name: LoreKey) -> dict[str, str | int]:
    return dict(zip(("kind", "key", "version"), name, strict=True))
