"""Union of two memories: exact in any order and grouping, and the same when done twice.

Tombstones of both count. Should one identity stand for two different contributions (the same task given to
two memories by hand carries two stamps), the one with the smaller (stamp, digest) stays, so that both
memories end with the same one whichever way they are merged.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy import Connection

from lifelore.memory import cache, ledger
from lifelore.memory.contribution import Identity
from lifelore.memory.folding import Stored, fold
from lifelore.memory.ledger import Entry
from lifelore.memory.refusal import one_line_refusals


@dataclass(frozen=True)
class _Plan:
    """What a merge will do: rows to remove here, rows to add from there."""

    remove: list[Entry]
    add: list[Entry]
    added: int
    already_there: int
    forgotten: int


def merge(here: Connection, there: Connection, source: str) -> dict[str, int]:
    """Bring everything of `there` into `here`, in the transaction of `here`.

    Parameters
    ----------
    here, there : Connection
        The transactions to write in and to read from.
    source : str
        Where `there` is, for the message when it cannot be read.

    Returns
    -------
    dict
        ``added`` contributions; ``already_there``; ``forgotten``: kept out by a tombstone of either
        memory, or removed here by one of the other's.
    """
    with one_line_refusals(source):
        theirs, graves = ledger.entries(there), ledger.tombstones(there)
    ledger.bury(here, graves)
    plan = _plan(ledger.entries(here), theirs, ledger.tombstones(here))
    remove(here, plan.remove)
    offered = _read(there, [entry.number for entry in plan.add], source)
    cache.write(here, fold(ledger.insert(here, stored.contribution) for stored in offered))
    return {"added": plan.added, "already_there": plan.already_there, "forgotten": plan.forgotten}


def _read(there: Connection, numbers: list[int], source: str) -> Iterator[Stored]:
    with one_line_refusals(source):
        yield from ledger.load(there, numbers)


def remove(conn: Connection, gone: list[Entry]) -> None:
    """Delete contributions and fold the keys they had anew."""
    if gone:
        numbers = [entry.number for entry in gone]
        stale = cache.mentioned(conn, numbers)
        ledger.remove(conn, numbers)
        cache.rebuild(conn, stale)


def _plan(own: list[Entry], theirs: list[Entry], graves: set[Identity]) -> _Plan:
    here = {entry.identity: entry for entry in own}
    buried = [entry for entry in own if entry.identity in graves]
    offered = [entry for entry in theirs if entry.identity not in graves]
    new = [entry for entry in offered if entry.identity not in here]
    earlier = [entry for entry in offered if entry.identity in here and _earlier(entry, here[entry.identity])]
    return _Plan(
        remove=buried + [here[entry.identity] for entry in earlier],
        add=sorted(new + earlier, key=lambda entry: entry.order),
        added=len(new),
        already_there=len(offered) - len(new),
        forgotten=len(buried) + len(theirs) - len(offered),
    )


def _earlier(entry: Entry, other: Entry) -> bool:
    return (entry.stamp, entry.digest) < (other.stamp, other.digest)
