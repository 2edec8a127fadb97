"""What a memory holds, as plain data."""

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, text

from lifelore.memory import schema

_ROBOTS = text("SELECT robot, COUNT(*), MIN(stamp), MAX(stamp) FROM lifelore_contributions GROUP BY robot")
# Sums of halves: a sum of 64-bit numbers may need more than 64 bits, and SQLite would stop there.
_LORE = text(
    "SELECT kind, key, version, merge, COUNT(slot), COALESCE(SUM(value >> 32), 0),"
    " COALESCE(SUM(value & 4294967295), 0)"
    " FROM lifelore_lore LEFT JOIN lifelore_cells ON lore = number"
    " GROUP BY kind, key, version, merge"
)


def overview(conn: Connection, location: str) -> dict[str, Any]:
    """Location, schema, robots with their tasks, keys with their size, number of tombstones."""
    graves = conn.execute(text("SELECT COUNT(*) FROM lifelore_tombstones")).scalar_one()
    return {
        "location": location,
        "schema": schema.version(conn),
        "robots": robots(conn),
        "lore": _lore(conn),
        "forgotten": int(graves),
    }


def robots(conn: Connection) -> list[dict[str, Any]]:
    """One entry a robot, sorted by name: ``robot``, ``tasks``, ``first`` and ``last`` time (UTC)."""
    return [
        {"robot": row[0], "tasks": int(row[1]), "first": _iso(row[2]), "last": _iso(row[3])}
        for row in sorted(tuple(row) for row in conn.execute(_ROBOTS))
    ]


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
