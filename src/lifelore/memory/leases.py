"""Leases of tasks: processes of one robot take different tasks, and the task of a killed process is taken again.

A robot's tasks have the numbers 0, 1, 2, …. A lease is a row that says which process is at work on a task; the
contribution of the task deletes it in the same transaction. So every number below *contributions + leases* is
finished or leased, and the sum is the next number that nobody has taken. Leases are no content: merges and exports
leave them out.
"""

import os
import time
from functools import cache
from pathlib import Path

from lifelore.memory.connection import Connection
from lifelore.memory.contribution import Identity

LEASE_SECONDS = 3600
"""Time after which a task may be taken again although nobody knows that its process has died. A longer time delays
the tasks of killed processes on other machines; a task that needs more may be done twice, and is stored once."""

_FINISHED = "SELECT COUNT(*) FROM lifelore_contributions WHERE robot = ?"
_LEASES = "SELECT number, holder, until FROM lifelore_leases WHERE robot = ? ORDER BY number"
_TAKE = (
    "INSERT INTO lifelore_leases (robot, number, process, holder, until)"
    " VALUES (?, ?, ?, ?, ?) ON CONFLICT (robot, number) DO UPDATE"
    " SET process = excluded.process, holder = excluded.holder, until = excluded.until"
)
_OWN = " WHERE robot = ? AND process = ? AND number = ?"


def take(conn: Connection, robot: str, process: str, seconds: int) -> int:
    """Take the lowest task whose lease has ended, else the next new one; return its number."""
    now = time.time_ns()
    held = conn.execute(_LEASES, (robot,)).fetchall()
    ended = [number for number, holder, until in held if until <= now or has_died(holder)]
    number = ended[0] if ended else _next(conn, robot, {number for number, _, _ in held})
    conn.execute(_TAKE, (robot, number, process, holder_of_this_process(), now + seconds * 10**9))
    return number


def _next(conn: Connection, robot: str, held: set[int]) -> int:
    number = conn.value(_FINISHED, (robot,)) + len(held)
    while number in held:
        number += 1
    return number


def finish(conn: Connection, identity: Identity, number: int) -> bool:
    """End the lease of a finished task; False if the process does not hold it any more."""
    return conn.first(f"DELETE FROM lifelore_leases{_OWN} RETURNING number", (*identity[:2], number)) is not None


def give_back(conn: Connection, robot: str, process: str, number: int) -> None:
    """End the lease of an unfinished task, which is the next to be taken; do nothing if another process has it."""
    # The row stays, so that the number does not get lost between those of tasks that are finished or leased.
    conn.execute("UPDATE lifelore_leases SET until = 0" + _OWN, (robot, process, number))


def forget(conn: Connection, robot: str) -> None:
    """Delete the leases of a robot."""
    conn.execute("DELETE FROM lifelore_leases WHERE robot = ?", (robot,))


def holder_of_this_process() -> str:
    """This process as `has_died` knows it: boot of the machine, process namespace, pid and start time."""
    pid = os.getpid()
    return f"{machine() or 'unknown'} {pid} {_started(pid)}"


def has_died(holder: str) -> bool:
    """Whether a process of this machine has ended; False if it lives, or if nobody here can know."""
    where, pid, started = holder.rsplit(" ", 2)
    if where != machine():
        return False
    try:
        os.kill(int(pid), 0)
    except ProcessLookupError:
        return True
    except PermissionError:
        return False
    return _started(int(pid)) != started


@cache
def machine() -> str | None:
    """The boot of this machine and the namespace of its process ids; None where the system has no /proc."""
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
        return f"{boot} {os.readlink('/proc/self/ns/pid')}"
    except OSError:
        return None


def _started(pid: int) -> str:
    """Start time of a process in clock ticks since boot; "ended" for a process that has ended."""
    try:
        state, *fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:
        return "ended"
    return "ended" if state in "ZX" else fields[18]
