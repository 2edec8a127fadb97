"""Merges memories: the result does not depend on order and grouping, and merging twice changes nothing.

The tombstones of all memories count. If an identity has two different contributions (a user stored the same task
in two memories, with two stamps), the one with the smaller (stamp, digest) stays in every memory.

Contributions are copied source by source, with one batch in main memory at a time. The cache is updated once at
the end, so that the cells of a key are written once and not once for each source.
"""

from collections.abc import Iterator, Mapping

from lifelore.core.errors import StoreError
from lifelore.memory import cache, ledger
from lifelore.memory.connection import Connection
from lifelore.memory.contribution import Contribution
from lifelore.memory.folding import LoreKey, Stored, fold
from lifelore.memory.ledger import ContributionRow
from lifelore.memory.refusal import one_line_refusals

Counts = dict[str, int]
"""``added``; ``already_there``; ``forgotten``: not added, or removed here, because of a tombstone."""


class MemoryUnion:
    """Merges other memories into one, in one transaction: `take` each source, then `finish`.

    After an error, roll the transaction back.

    Parameters
    ----------
    here : Connection
        The transaction to write in.
    """

    def __init__(self, here: Connection) -> None:
        self._here = here
        self._own = {entry.identity: entry for entry in ledger.entries(here)}
        self._tombstones = ledger.tombstones(here)
        self._forgotten = ledger.forgotten_records(here)
        self._sources: dict[int, str] = {}
        self._source = ""  # of the contribution at work, for error messages
        self._stale: set[LoreKey] = set()

    def take(self, there: Connection, source: str) -> Counts:
        """Copy the contributions and tombstones of one source; `finish` updates the cache.

        Parameters
        ----------
        there : Connection
            The transaction to read from; may be the transaction of this memory.
        source : str
            Location of `there`, for error messages.
        """
        with one_line_refusals(source):
            theirs, tombstones = ledger.entries(there), ledger.tombstones(there)
            self._forget(ledger.forgotten_records(there))
        ledger.add_tombstones(self._here, tombstones - self._tombstones)
        self._tombstones |= tombstones
        gone = [entry for entry in self._own.values() if entry.identity in self._tombstones]
        offered = [entry for entry in theirs if entry.identity not in self._tombstones]
        new = [entry for entry in offered if entry.identity not in self._own]
        both = [(entry, self._own[entry.identity]) for entry in offered if entry.identity in self._own]
        earlier = [(entry, own) for entry, own in both if (entry.stamp, entry.digest) < (own.stamp, own.digest)]
        self._remove([*gone, *(own for _, own in earlier)])
        copied = sorted([*new, *(entry for entry, _ in earlier)], key=lambda entry: entry.order)
        for entry in ledger.insert_many(self._here, _read(there, [entry.number for entry in copied], source)):
            self._own[entry.identity] = entry
            self._sources[entry.number] = source
        n_forgotten = len(gone) + len(theirs) - len(offered)
        return {"added": len(new), "already_there": len(both), "forgotten": n_forgotten}

    def finish(self) -> None:
        """Update the cache.

        Raises
        ------
        StoreError
            A copied contribution is damaged or has another merge for a key; the message names its source.
        """
        self._strip_copied()
        if self._stale:
            cache.rebuild(self._here, self._stale)
        try:
            for name, part in fold(self._copied()).items():
                self._source = self._sources[part.mentions[0]]
                cache.write(self._here, {name: part})
        except StoreError as error:
            raise StoreError(f"memory {self._source}: {error}") from error

    def _forget(self, theirs: dict[LoreKey, int]) -> None:
        """Forget records here that a source has forgotten; copied contributions wait for `finish`."""
        news = {name: stamp for name, stamp in theirs.items() if stamp > self._forgotten.get(name, -1)}
        self._forgotten |= news
        self._stale |= forget_records(self._here, news)

    def _strip_copied(self) -> None:
        if not self._forgotten:
            return
        for entry in ledger.strip(self._here, sorted(self._sources.keys() & self._numbers()), self._forgotten):
            self._own[entry.identity] = entry

    def _numbers(self) -> set[int]:
        return {entry.number for entry in self._own.values()}

    def _remove(self, removed: list[ContributionRow]) -> None:
        # The cache does not hold copied contributions before `finish`, so `delete` finds no keys of them.
        self._stale |= delete(self._here, [entry.number for entry in removed])
        for entry in removed:
            del self._own[entry.identity]

    def _copied(self) -> Iterator[Stored]:
        """The copied contributions that stay, oldest first."""
        copied = [entry for entry in self._own.values() if entry.number in self._sources]
        numbers = [entry.number for entry in sorted(copied, key=lambda entry: entry.order)]
        for stored in ledger.load(self._here, numbers):
            self._source = self._sources[stored.number]
            yield stored


def _read(there: Connection, numbers: list[int], source: str) -> Iterator[Contribution]:
    with one_line_refusals(source):
        yield from (stored.contribution for stored in ledger.load(there, numbers))


def delete(conn: Connection, numbers: list[int]) -> set[LoreKey]:
    """Delete contributions by row number; return the keys whose cache must be rebuilt."""
    stale = cache.mentioned(conn, numbers)
    ledger.remove(conn, numbers)
    return stale


def forget_records(conn: Connection, forgotten: Mapping[LoreKey, int]) -> set[LoreKey]:
    """Delete the records of these keys from contributions up to the stamps; return the keys of stale cache."""
    ledger.add_forgotten_records(conn, forgotten)
    stale, numbers = set(), set()
    for name in forgotten:
        if mentions := cache.mentions(conn, name):
            stale.add(name)
            numbers |= mentions
    ledger.strip(conn, sorted(numbers), forgotten)
    return stale
