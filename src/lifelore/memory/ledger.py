"""SQL of contributions, and of the tombstones of forgotten ones."""

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TypeVar

from lifelore.core.errors import StoreError
from lifelore.memory.connection import Connection
from lifelore.memory.contribution import Contribution, Identity, LoreKey, Order
from lifelore.memory.folding import Stored
from lifelore.memory.record_rules import LARGEST

Item = TypeVar("Item")
# Rows fetched or named in one statement: a hundred blobs are about 2 MB, and SQLite allows 32,766 names.
BATCH = 100

_IDENTITY = "robot = ? AND process = ? AND seq = ?"
# Inserts nothing where the contribution is stored already, or was forgotten.
_INSERT = (
    "INSERT INTO lifelore_contributions (robot, process, seq, stamp, task, blob, digest)"
    " SELECT ?, ?, ?, ?, ?, ?, ?"
    f" WHERE NOT EXISTS (SELECT 1 FROM lifelore_tombstones WHERE {_IDENTITY})"
    " ON CONFLICT (robot, process, seq) DO NOTHING"
)
_LAST = "SELECT COALESCE(MAX(number), 0) FROM lifelore_contributions"
_SINCE = "SELECT number, robot, process, seq, stamp, digest FROM lifelore_contributions WHERE number > ?"
_KNOWN = (
    f"SELECT 1 FROM lifelore_contributions WHERE {_IDENTITY}"
    f" UNION ALL SELECT 1 FROM lifelore_tombstones WHERE {_IDENTITY}"
)
# A maximum for each table: one over the union of their rows would read them all.
_LARGEST_STAMP = (
    "SELECT COALESCE(MAX(stamp), 0) FROM (SELECT MAX(stamp) AS stamp FROM lifelore_contributions"
    " UNION ALL SELECT MAX(stamp) FROM lifelore_forgotten_records) AS stamps"
)
_FORGET_RECORD = (
    "INSERT INTO lifelore_forgotten_records (kind, key, version, stamp) VALUES (?, ?, ?, ?)"
    " ON CONFLICT (kind, key, version) DO UPDATE SET stamp = excluded.stamp"
    " WHERE excluded.stamp > lifelore_forgotten_records.stamp"
)
_ADD_TOMBSTONE = "INSERT INTO lifelore_tombstones (robot, process, seq) VALUES (?, ?, ?) ON CONFLICT DO NOTHING"
_LOAD = (
    "SELECT number, robot, process, seq, stamp, task, blob, digest FROM lifelore_contributions"
    " WHERE number IN ({})"
)


@dataclass(frozen=True)
class ContributionRow:
    """Row number, identity, stamp and digest of a contribution, without its blob."""

    number: int
    identity: Identity
    stamp: int
    digest: str

    @property
    def order(self) -> Order:
        """As `Contribution.order`."""
        return self.stamp, *self.identity


def in_batches(items: Iterable[Item], size: int = BATCH) -> Iterator[list[Item]]:
    """`items` in lists of at most `size`."""
    iterator = iter(items)
    while batch := list(islice(iterator, size)):
        yield batch


def is_known(conn: Connection, identity: Identity) -> bool:
    """Whether the memory stores this contribution, or has forgotten it."""
    return conn.first(_KNOWN, identity * 2) is not None


def next_stamp(conn: Connection) -> int:
    """A stamp that is later than the clock and than every stamp in this memory."""
    largest = conn.value(_LARGEST_STAMP)
    if largest >= LARGEST:
        raise StoreError("a contribution has the largest possible stamp; forget the robot whose clock is wrong")
    return max(time.time_ns(), int(largest) + 1)


def insert(conn: Connection, identity: Identity, task: str, payload: bytes) -> int | None:
    """Insert packed records as the newest contribution; its row number, or None where it is stored already or was
    forgotten."""
    contribution = Contribution.packed(identity, next_stamp(conn), task, payload)
    found = conn.first(_INSERT + " RETURNING number", (*contribution, *identity))
    return None if found is None else int(found[0])


def insert_many(conn: Connection, contributions: Iterable[Contribution]) -> list[ContributionRow]:
    """Insert contributions in batches, with one batch in main memory at a time."""
    last = conn.value(_LAST)
    for batch in in_batches(contributions):
        conn.execute_many(_INSERT, [(*contribution, *contribution.identity) for contribution in batch])
    return _entries(conn.execute(_SINCE, (last,)))


def entries(conn: Connection, robot: str | None = None) -> list[ContributionRow]:
    """All contributions, or one robot's, without their blobs, oldest first."""
    query = "SELECT number, robot, process, seq, stamp, digest FROM lifelore_contributions"
    rows = conn.execute(query) if robot is None else conn.execute(query + " WHERE robot = ?", (robot,))
    return sorted(_entries(rows), key=lambda entry: entry.order)


def tasks(conn: Connection) -> Iterator[tuple[int, Identity, str]]:
    """(row number, identity, description of the task) of each contribution."""
    for row in conn.execute("SELECT number, robot, process, seq, task FROM lifelore_contributions").fetchall():
        yield row[0], (row[1], row[2], row[3]), row[4]


def _entries(rows: Iterable[tuple]) -> list[ContributionRow]:
    return [ContributionRow(row[0], (row[1], row[2], row[3]), row[4], row[5]) for row in rows]


def load(conn: Connection, numbers: Iterable[int]) -> Iterator[Stored]:
    """The contributions of these row numbers, in this order, with one batch in main memory at a time."""
    for batch in in_batches(numbers):
        found = conn.execute(_LOAD.format(", ".join(map(str, batch))))
        rows = {row[0]: Stored(row[0], Contribution(*row[1:])) for row in found}
        for number in batch:
            yield _with_bytes(rows[number])


def _with_bytes(stored: Stored) -> Stored:
    if not isinstance(stored.contribution.blob, bytes):
        raise StoreError(f"contribution {stored.contribution.identity} holds no bytes; the memory is damaged")
    return stored


def tombstones(conn: Connection) -> set[Identity]:
    """The identities of all forgotten contributions."""
    return {
        (row[0], row[1], row[2]) for row in conn.execute("SELECT robot, process, seq FROM lifelore_tombstones")
    }


def add_tombstones(conn: Connection, identities: Iterable[Identity]) -> None:
    """Add a tombstone for each identity."""
    for batch in in_batches(sorted(identities), 1000):
        conn.execute_many(_ADD_TOMBSTONE, batch)


def forgotten_records(conn: Connection) -> dict[LoreKey, int]:
    """The keys of forgotten records, and the last stamp of the contributions that lose them."""
    rows = conn.execute("SELECT kind, key, version, stamp FROM lifelore_forgotten_records")
    return {(row[0], row[1], int(row[2])): int(row[3]) for row in rows}


def add_forgotten_records(conn: Connection, forgotten: Mapping[LoreKey, int]) -> None:
    """Add keys of forgotten records; of two stamps the later one counts."""
    for name, stamp in sorted(forgotten.items()):
        conn.execute(_FORGET_RECORD, (*name, stamp))


def strip(conn: Connection, numbers: Iterable[int], forgotten: Mapping[LoreKey, int]) -> list[ContributionRow]:
    """Delete the forgotten records from the contributions of these row numbers; return the changed rows."""
    update = "UPDATE lifelore_contributions SET blob = ?, digest = ? WHERE number = ?"
    changed = []
    for stored in load(conn, numbers):
        left = stored.contribution.without(forgotten)
        if left is not stored.contribution:
            conn.execute(update, (left.blob, left.digest, stored.number))
            changed.append(ContributionRow(stored.number, left.identity, left.stamp, left.digest))
    return changed


def remove(conn: Connection, numbers: Sequence[int]) -> None:
    """Delete contributions by row number."""
    statement = "DELETE FROM lifelore_contributions WHERE number = ?"
    for batch in in_batches(numbers, 1000):
        conn.execute_many(statement, [(number,) for number in batch])
