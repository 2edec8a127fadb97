"""MemoryUnion of memories: exact in any order and grouping, and the same when done twice.

Tombstones of all count. Should one identity stand for two different contributions (the same task given to
two memories by hand carries two stamps), the one with the smaller (stamp, digest) stays, so that all
memories end with the same one whichever way they are merged.

Contributions are copied source by source, a batch in memory at a time; the cache follows once, at the end, because
each key's cells are then written once and not once for each source.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from sqlalchemy import Connection

from lifelore.core.errors import StoreError
from lifelore.memory import cache, ledger
from lifelore.memory.contribution import Contribution, Identity
from lifelore.memory.folding import LoreKey, Stored, fold
from lifelore.memory.ledger import ContributionRow
from lifelore.memory.refusal import one_line_refusals

Counts = dict[str, int]
"""``added`` contributions; ``already_there``; ``forgotten``: kept out by a tombstone, or removed here by one."""


@dataclass(frozen=True)
class _Plan:
    """What a source will do: rows to remove here, rows to add from there."""

    remove: list[ContributionRow]
    add: list[ContributionRow]
    added: int
    already_there: int
    forgotten: int


class MemoryUnion:
    """One memory while others are brought into it, in one transaction.

    `take` each source, then `finish`. After an error nothing of the transaction may be kept.

    Parameters
    ----------
    here : Connection
        The transaction to write in.
    """

    def __init__(self, here: Connection) -> None:
        self._here = here
        self._own = {entry.identity: entry for entry in ledger.entries(here)}
        self._graves = ledger.tombstones(here)
        self._sources: dict[int, str] = {}
        self._stale: set[LoreKey] = set()

    def take(self, there: Connection, source: str) -> Counts:
        """Copy the contributions and tombstones of one source; the cache stays behind until `finish`.

        Parameters
        ----------
        there : Connection
            The transaction to read from; may be that of this memory itself.
        source : str
            Where `there` is, for messages.
        """
        with one_line_refusals(source):
            theirs, graves = ledger.entries(there), ledger.tombstones(there)
        ledger.bury(self._here, graves - self._graves)
        self._graves |= graves
        plan = _plan(self._own, theirs, self._graves)
        self._remove(plan.remove)
        for entry in ledger.insert_many(self._here, _read(there, [entry.number for entry in plan.add], source)):
            self._own[entry.identity] = entry
            self._sources[entry.number] = source
        return {"added": plan.added, "already_there": plan.already_there, "forgotten": plan.forgotten}

    def finish(self) -> None:
        """Bring the cache up to date.

        Raises
        ------
        StoreError
            A contribution that came is damaged, or merges a key differently; its source is named.
        """
        if self._stale:
            cache.rebuild(self._here, self._stale)
        for name, part in fold(self._came()).items():
            try:
                cache.write(self._here, {name: part})
            except StoreError as error:
                raise StoreError(f"memory {self._sources[part.mentions[0]]}: {error}") from error

    def _remove(self, gone: list[ContributionRow]) -> None:
        numbers = [entry.number for entry in gone]
        self._stale |= cache.mentioned(self._here, (number for number in numbers if number not in self._sources))
        ledger.remove(self._here, numbers)
        for entry in gone:
            del self._own[entry.identity]

    def _came(self) -> Iterator[Stored]:
        """The contributions that came and stayed, oldest first."""
        came = [entry for entry in self._own.values() if entry.number in self._sources]
        numbers = [entry.number for entry in sorted(came, key=lambda entry: entry.order)]
        for stored in ledger.load(self._here, numbers):
            yield replace(stored, source=self._sources[stored.number])


def _read(there: Connection, numbers: list[int], source: str) -> Iterator[Contribution]:
    with one_line_refusals(source):
        yield from (stored.contribution for stored in ledger.load(there, numbers))


def remove(conn: Connection, gone: list[ContributionRow]) -> None:
    """Delete contributions and fold the keys they had anew."""
    if gone:
        numbers = [entry.number for entry in gone]
        stale = cache.mentioned(conn, numbers)
        ledger.remove(conn, numbers)
        cache.rebuild(conn, stale)


def _plan(own: dict[Identity, ContributionRow], theirs: list[ContributionRow], graves: set[Identity]) -> _Plan:
    buried = [entry for entry in own.values() if entry.identity in graves]
    offered = [entry for entry in theirs if entry.identity not in graves]
    new = [entry for entry in offered if entry.identity not in own]
    earlier = [entry for entry in offered if entry.identity in own and _earlier(entry, own[entry.identity])]
    return _Plan(
        remove=buried + [own[entry.identity] for entry in earlier],
        add=sorted(new + earlier, key=lambda entry: entry.order),
        added=len(new),
        already_there=len(offered) - len(new),
        forgotten=len(buried) + len(theirs) - len(offered),
    )


def _earlier(entry: ContributionRow, other: ContributionRow) -> bool:
    return (entry.stamp, entry.digest) < (other.stamp, other.digest)
