"""The cache of merged records that `Memory.recall` reads, updated by additive upserts.

The state of key number n is cell 0 of lore −n, and its value is the token: one statement writes state and cells.
"""

import json
import secrets
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory import ledger, schema
from lifelore.memory.connection import Connection
from lifelore.memory.folding import Folded, LoreKey, fold, require_one_merge
from lifelore.memory.record_rules import described

_ROWS_AT_ONCE = 10_000
_FEW_ROWS = 16
"""Cells that are written by one statement; a statement of more would be too long for more speed."""
EVERY_SLOT = -(2**63), 2**63 - 1

# "The contribution of the new row is later than that of the row in place."
_LATER = """EXISTS (
    SELECT 1 FROM lifelore_contributions AS new, lifelore_contributions AS old
    WHERE new.number = excluded.origin AND old.number = {table}.origin
    AND (new.stamp, new.robot, new.process, new.seq) > (old.stamp, old.robot, old.process, old.seq))"""

# "No contribution that has its key beside it is later than the new row."
_NEWEST = """NOT EXISTS (
    SELECT 1 FROM lifelore_contributions AS new, lifelore_contributions AS other
    WHERE new.number = excluded.origin AND other.lore = lifelore_lore.number
    AND (other.stamp, other.robot, other.process, other.seq) > (new.stamp, new.robot, new.process, new.seq))"""

_NOTE = (
    "INSERT INTO lifelore_lore (kind, key, version, merge, about, origin)"
    " VALUES (:kind, :key, :version, :merge, :about, :origin) ON CONFLICT (kind, key, version)"
    " DO UPDATE SET about = excluded.about, origin = excluded.origin"
    f" WHERE {_LATER.format(table='lifelore_lore')} AND {_NEWEST}"
)
_CELLS = "INSERT INTO lifelore_cells (lore, slot, value, origin) VALUES {} ON CONFLICT (lore, slot) DO UPDATE SET "
_CELL = "(?, ?, ?, ?)"
_UPSERT = {
    "add": _CELLS + "value = lifelore_cells.value + excluded.value",
    "union": _CELLS + "value = excluded.value WHERE excluded.value > lifelore_cells.value",
    "newest": (
        _CELLS + f"value = excluded.value, origin = excluded.origin WHERE {_LATER.format(table='lifelore_cells')}"
    ),
}
_MENTION = "INSERT INTO lifelore_mentions (contribution, lore) VALUES (?, ?)"
_MENTIONS = "SELECT contribution FROM lifelore_mentions WHERE lore = :lore"
_BESIDE = " UNION SELECT number FROM lifelore_contributions WHERE lore = :lore"
_NAMED = "kind = ? AND key = ? AND version = ?"
# Cells of the newest contribution, and the state; a state stays only if its key has the token it was computed for.
_ADD = (
    "INSERT INTO lifelore_cells (lore, slot, value, origin, state) VALUES {} ON CONFLICT (lore, slot)"
    " DO UPDATE SET value = excluded.value, origin = excluded.origin,"
    " state = CASE WHEN lifelore_cells.value = ? THEN excluded.state END"
)
_ADDED = "(?, ?, ?, ?, ?)"
_TOKEN = "SELECT value FROM lifelore_cells WHERE lore = ? AND slot = 0"
_STATES = (
    "SELECT kind, key, version, merge, COALESCE(own.value, 0), own.state, about, NULL, NULL FROM lifelore_lore"
    " LEFT JOIN lifelore_cells AS own ON own.lore = -lifelore_lore.number AND own.slot = 0 WHERE {}"
)
_SLOTS = (
    " UNION ALL SELECT NULL, NULL, NULL, NULL, NULL, NULL, NULL, slot, value FROM lifelore_cells"
    f" WHERE lore = (SELECT number FROM lifelore_lore WHERE {_NAMED}) AND slot BETWEEN ? AND ?"
)
_FIND = f"SELECT number, merge, about FROM lifelore_lore WHERE {_NAMED}"
_READ = "SELECT slot, value FROM lifelore_cells WHERE lore = ? AND slot BETWEEN ? AND ? ORDER BY slot"


class KeyState(NamedTuple):
    """A state that a learner computed from the cells of a key, stored beside them.

    Every change of the key deletes the stored state, unless the change brings the state that follows it.

    name : (kind, key, version)
    token : of the cells that the state was computed from, see `StoredState`; None: the key did not exist
    content : bytes, which memory does not interpret
    """

    name: LoreKey
    token: int | None
    content: bytes


class StoredState(NamedTuple):
    """The state of a key as it is stored.

    token : another number after each change of the key's cells, whoever changes them
    content : bytes, or None where the last change brought no state
    about : the newest description of the key
    record : with the slots that were asked for; None where none were
    """

    token: int
    content: bytes | None
    about: Mapping[str, Any]
    record: Record | None = None


def add(
    conn: Connection, parts: dict[LoreKey, Folded], lore: int | None = None, state: KeyState | None = None
) -> None:
    """Merge the newest contribution into the cache; the ledger must hold it already.

    `lore` is the number of its only key, see `ledger.Inserted`. `state` is stored if nobody else has changed its
    key since it was computed.
    """
    if lore is None or len(parts) != 1:
        return write(conn, parts, state)
    ((name, part),) = parts.items()
    if len(part.slots) >= _FEW_ROWS:
        return write(conn, parts, state)
    own = state if state is not None and state.name == name else None
    cells = zip(part.slots.tolist(), part.values.tolist(), strict=True)
    token = -lore, 0, _new_token(), part.origin, own.content if own else None
    rows = [token, *((lore, slot, value, part.origin, None) for slot, value in cells)]
    values = [number for row in rows for number in row]
    conn.execute(_ADD.format(", ".join([_ADDED] * len(rows))), [*values, own.token if own else None])
    return None


def write(conn: Connection, folded: dict[LoreKey, Folded], state: KeyState | None = None) -> None:
    """Merge folded contributions of any age into the cache; the ledger must hold them already.

    `state` as in `add`.
    """
    for name, part in sorted(folded.items()):
        note = {**_named(name), "merge": part.merge, "about": described(part.about), "origin": part.origin}
        conn.execute(_NOTE, note)
        lore, merge, _ = conn.execute(_FIND, name).fetchone()
        require_one_merge(name, {merge, part.merge})
        conn.execute_many(_MENTION, [(number, lore) for number in part.mentions])
        _write_cells(conn, lore, part)
        token = conn.first(_TOKEN, (-lore,))
        follows = state is not None and state.name == name and (state.token or 0) == (token[0] if token else 0)
        content = state.content if follows and state is not None else None
        conn.execute(
            _ADD.format(_ADDED), [-lore, 0, _new_token(), part.origin, content, token[0] if token else None]
        )


def _new_token() -> int:
    """A random number, because a key that is deleted and written again must not get an earlier token again."""
    return secrets.randbits(62)


def read_states(
    conn: Connection, names: Sequence[LoreKey], slots: tuple[int, int] | None = None
) -> list[StoredState | None]:
    """The states of keys, and the cells of the first key within `slots`; None where there is no key."""
    sql, parameters = _STATES.format(" OR ".join([f"({_NAMED})"] * len(names))), list(chain.from_iterable(names))
    if slots is not None:
        sql, parameters = sql + _SLOTS, [*parameters, *names[0], *slots]
    rows = conn.execute(sql, parameters).fetchall()
    cells = [(slot, value) for *_, slot, value in rows if slot is not None]
    found: dict[LoreKey, StoredState] = {}
    for kind, key, version, merge, token, state, about, slot, _ in rows:
        if slot is None:
            name, described = (kind, key, version), json.loads(about)
            wanted = slots is not None and name == names[0]
            record = Record(*name, merge, *_columns(sorted(cells)), described) if wanted else None
            found[name] = StoredState(token, state, described, record)
    return [found.get(name) for name in names]


def read_without_states(
    conn: Connection, names: Sequence[LoreKey], slots: tuple[int, int] | None = None
) -> list[StoredState | None]:
    """As `read_states` of a memory of an older schema that is only read: its states are left out."""
    found = [read(conn, name, slots or (0, 0)) for name in names]
    wanted = [slots is not None and place == 0 for place in range(len(names))]
    return [
        one and StoredState(0, None, one.about, one if asked else None)
        for one, asked in zip(found, wanted, strict=True)
    ]


def _columns(cells: Iterable[tuple[int, int]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    table = np.fromiter(chain.from_iterable(cells), np.int64).reshape(-1, 2)
    return np.ascontiguousarray(table[:, 0]), np.ascontiguousarray(table[:, 1])


def _write_cells(conn: Connection, lore: int, part: Folded) -> None:
    """Upsert the cells of a key. Only *newest* needs the origin of a value; the other merges store 0."""
    origins = part.origins if part.merge == "newest" else np.zeros_like(part.origins)
    slots, values = part.slots.tolist(), part.values.tolist()
    rows = list(zip([lore] * len(slots), slots, values, origins.tolist(), strict=True))
    upsert = _UPSERT[part.merge]
    if 0 < len(rows) <= _FEW_ROWS:
        conn.execute(upsert.format(", ".join([_CELL] * len(rows))), list(chain.from_iterable(rows)))
        return
    for batch in ledger.in_batches(rows, _ROWS_AT_ONCE):
        conn.execute_many(upsert.format(_CELL), batch)


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
    beside = (
        "SELECT kind, key, version FROM lifelore_lore JOIN lifelore_contributions AS own"
        " ON own.lore = lifelore_lore.number WHERE own.number = ?"
    )
    found = (conn.execute(sql, (number,)) for number in contributions for sql in (query, beside))
    return {(row[0], row[1], row[2]) for rows in found for row in rows}


def mentions(conn: Connection, name: LoreKey) -> set[int]:
    """Row numbers of the contributions that have a record of this key."""
    found = conn.first(_FIND, name)
    return set() if found is None else mentions_of(conn, found[0])


def mentions_of(conn: Connection, lore: int) -> set[int]:
    """`mentions` by the number of the key."""
    sql = _MENTIONS + (_BESIDE if schema.version(conn) >= schema.BESIDE else "")
    return {row[0] for row in conn.execute(sql, {"lore": lore})}


def rebuild(conn: Connection, only: set[LoreKey] | None = None) -> None:
    """Delete the cache, of the keys in `only` or of all keys, and compute it again from the contributions."""
    if only is None:
        for table in ("cells", "mentions", "lore"):
            conn.execute(f"DELETE FROM lifelore_{table}")
        conn.execute("UPDATE lifelore_contributions SET lore = NULL WHERE lore IS NOT NULL")
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
        conn.execute("UPDATE lifelore_contributions SET lore = NULL WHERE lore = ?", lore)
        conn.execute("DELETE FROM lifelore_cells WHERE lore IN (?, ?)", (found[0], -found[0]))
        conn.execute("DELETE FROM lifelore_mentions WHERE lore = ?", lore)
        conn.execute("DELETE FROM lifelore_lore WHERE number = ?", lore)
    return numbers


def _named(name: LoreKey) -> dict[str, str | int]:
    return dict(zip(("kind", "key", "version"), name, strict=True))
