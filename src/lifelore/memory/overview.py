"""Summarises the content of a memory as JSON data: robots, records, number of tombstones."""

from collections.abc import Callable, Hashable, Iterable
from datetime import UTC, datetime
from typing import Any

from lifelore.memory import ledger, schema
from lifelore.memory.connection import Connection

FEW = 8
"""Maximum number of entries of a group that are listed separately; more are joined to one entry."""

_ROBOTS = "SELECT robot, COUNT(*), MIN(stamp), MAX(stamp) FROM lifelore_contributions GROUP BY robot"
# Sums of halves, because a sum of 64-bit numbers may need more than 64 bits, which is an error in SQLite.
_LORE = (
    "SELECT kind, key, version, merge, COUNT(slot), COALESCE(SUM(value >> 32), 0),"
    " COALESCE(SUM(value & 4294967295), 0)"
    " FROM lifelore_lore LEFT JOIN lifelore_cells ON lore = number"
    " GROUP BY kind, key, version, merge"
)


def overview(conn: Connection, location: str) -> dict[str, Any]:
    """Location, schema, robots with their tasks, keys with their size, number of tombstones."""
    tombstones = conn.value("SELECT COUNT(*) FROM lifelore_tombstones")
    return {
        "location": location,
        "schema": schema.version(conn),
        "robots": robots(conn),
        "lore": _lore(conn),
        "forgotten": int(tombstones),
        "forgotten_records": len(ledger.forgotten_records(conn)),
    }


def revision(conn: Connection) -> str:
    """Last number of a contribution, number of tombstones, and last stamp of a forgotten record."""
    # Numbers of contributions are never given twice, and each forgotten contribution has a tombstone.
    last = conn.value("SELECT COALESCE(MAX(number), 0) FROM lifelore_contributions")
    tombstones = conn.value("SELECT COUNT(*) FROM lifelore_tombstones")
    forgotten = max(ledger.forgotten_records(conn).values(), default=0)
    return f"{last}-{tombstones}-{forgotten}"


def robots(conn: Connection) -> list[dict[str, Any]]:
    """One entry a robot, sorted by name: ``robot``, ``tasks``, ``first`` and ``last`` time (UTC)."""
    return [
        {"robot": row[0], "tasks": int(row[1]), "first": _iso(row[2]), "last": _iso(row[3])}
        for row in sorted(tuple(row) for row in conn.execute(_ROBOTS))
    ]


def grouped_robots(robots: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Entries of `robots`, with more than `FEW` robots ``GROUP: NAME`` of a group joined to one entry.

    Each entry also has ``of``, the number of its robots; the ``robot`` of a joined entry is ``GROUP: ``.
    """
    groups = _grouped(robots, lambda one: _stem(one["robot"], ": "))
    return [
        {
            "robot": _stem(group[0]["robot"], ": "), "tasks": sum(one["tasks"] for one in group),
            "first": min(one["first"] for one in group), "last": max(one["last"] for one in group),
            "of": len(group),
        } if len(group) > 1 else group[0] | {"of": 1}
        for group in groups
    ]  # fmt: skip


def grouped_lore(lore: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Records of `overview`, with more than `FEW` keys ``GROUP/NAME`` of a kind joined to one entry.

    Each entry also has ``of``, the number of its keys; a joined entry has the ``key`` ``GROUP/``, and sums as
    ``slots`` and ``sum``.
    """
    groups = _grouped(lore, lambda one: (one["kind"], _stem(one["key"], "/"), one["version"], one["merge"]))
    return [
        group[0] | {
            "key": _stem(group[0]["key"], "/") if len(group) > 1 else group[0]["key"],
            "slots": sum(one["slots"] for one in group), "sum": sum(one["sum"] for one in group),
            "of": len(group),
        }
        for group in groups
    ]  # fmt: skip


def _grouped(
    entries: Iterable[dict[str, Any]], sort: Callable[[dict[str, Any]], Hashable]
) -> list[list[dict[str, Any]]]:
    """Lists of entries with an equal sort key if there are more than `FEW`, else lists of one; in order."""
    groups: dict[Hashable, list[dict[str, Any]]] = {}
    for entry in entries:
        groups.setdefault(sort(entry), []).append(entry)
    parted = ([group] if len(group) > FEW else [[one] for one in group] for group in groups.values())
    return [group for part in parted for group in part]


def _stem(name: str, separator: str) -> str:
    """The name up to and with the separator; the whole name without one."""
    head, found, _ = name.partition(separator)
    return head + found if found else name


def _lore(conn: Connection) -> list[dict[str, Any]]:
    return [
        {
            "kind": row[0], "key": row[1], "version": row[2], "merge": row[3],
            "slots": int(row[4]), "sum": (int(row[5]) << 32) + int(row[6]),
        }
        for row in sorted(tuple(row) for row in conn.execute(_LORE))
    ]  # fmt: skip


def _iso(stamp: int) -> str:
    return datetime.fromtimestamp(stamp // 10**9, UTC).isoformat()
