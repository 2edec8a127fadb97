"""Checks that the contributions are undamaged and that the cache agrees with them."""

from collections.abc import Iterator

import numpy as np

from lifelore.core.errors import StoreError
from lifelore.memory import cache, ledger
from lifelore.memory.connection import Connection
from lifelore.memory.folding import Folded, LoreKey, fold


def problems(conn: Connection) -> list[str]:
    """One line for each problem; empty for a sound memory."""
    found = list(_file_problems(conn))
    oldest_first = ledger.entries(conn)
    tombstones = ledger.tombstones(conn)
    found += [
        f"contribution {one.identity} is stored although it was forgotten"
        for one in oldest_first
        if one.identity in tombstones
    ]
    forgotten = ledger.forgotten_records(conn)
    found += list(_forgotten_but_stored(conn, oldest_first, forgotten))
    numbers = [entry.number for entry in oldest_first]
    # With a damaged contribution, a comparison of the cache is meaningless, so damage is reported alone.
    return found + (list(_damaged(conn, numbers)) or list(_cache_problems(conn, numbers)))


def _file_problems(conn: Connection) -> Iterator[str]:
    if conn.is_sqlite:
        for (message,) in conn.execute("PRAGMA integrity_check(10)"):
            if message != "ok":
                yield "the file: " + " ".join(message.split())


def _forgotten_but_stored(
    conn: Connection, entries: list[ledger.ContributionRow], forgotten: dict[LoreKey, int]
) -> Iterator[str]:
    by_number = {entry.number: entry for entry in entries}
    for name, stamp in sorted(forgotten.items()):
        for number in sorted(cache.mentions(conn, name)):
            if number in by_number and by_number[number].stamp <= stamp:
                label = f"{name[0]}/{name[1]} version {name[2]}"
                yield f"contribution {by_number[number].identity} has a record of {label}, which was forgotten"


def _damaged(conn: Connection, numbers: list[int]) -> Iterator[str]:
    for stored in ledger.load(conn, numbers):
        try:
            stored.contribution.records()
        except StoreError as error:
            yield f"contribution {stored.contribution.identity}: {error}"


def _cache_problems(conn: Connection, numbers: list[int]) -> Iterator[str]:
    expected = fold(ledger.load(conn, numbers))
    rows = conn.execute("SELECT kind, key, version, number FROM lifelore_lore")
    cached = {(row[0], row[1], row[2]): row[3] for row in rows}
    for name in sorted(cached.keys() | expected.keys()):
        label = f"cache of {name[0]}/{name[1]} version {name[2]}"
        if name not in cached:
            yield f"{label} is missing; rebuild the memory"
        elif name not in expected:
            yield f"{label} has no contribution; rebuild the memory"
        elif not _agrees(conn, name, cached[name], expected[name]):
            yield f"{label} differs from its contributions; rebuild the memory"
    yield from _orphans(conn)


def _orphans(conn: Connection) -> Iterator[str]:
    for table in ("cells", "mentions"):
        unknown = "lore NOT IN (SELECT number FROM lifelore_lore)"
        if count := conn.value(f"SELECT COUNT(*) FROM lifelore_{table} WHERE {unknown}"):
            yield f"{count} rows of lifelore_{table} belong to no key; rebuild the memory"


def _agrees(conn: Connection, name: LoreKey, lore: int, part: Folded) -> bool:
    record = cache.read(conn, name)
    return (
        record is not None
        and record.merge == part.merge
        and record.about == part.about
        and np.array_equal(record.slots, part.slots)
        and np.array_equal(record.values, part.values)
        and cache.mentions_of(conn, lore) == set(part.mentions)
    )
