"""Summarises the content of a memory as JSON data: robots, records, number of tombstones."""

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


def grouped_lore(lore: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Records of `overview`, with more than `FEW` keys ``GROUP/NAME`` of a kind joined to one entry.

    Each entry also has ``of``, the number of its keys; a joined entry has the ``key`` ``GROUP/``, and sums as
    ``slots`` and ``sum``.
    """
    groups: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
    for one in lore:
        head, slash, _ = one["key"].partition("/")
        groups.setdefault((one["kind"], head + slash, one["version"], one["merge"]), []).append(one)
    found = []
    for (_, stem, *_), group in groups.items():
        if len(group) > FEW:
            sums = {name: sum(one[name] for one in group) for name in ("slots", "sum")}
            found.append(group[0] | sums | {"key": stem, "of": len(group)})
        else:
            found += [one | {"of": 1} for one in group]
    return found


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
