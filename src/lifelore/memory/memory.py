"""Memory: lore kept between runs, in a file or on a PostgreSQL server."""

from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from sqlalchemy import URL, Connection, text

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.memory import audit, cache, ledger, merging, overview
from lifelore.memory.contribution import new_contribution
from lifelore.memory.export import export
from lifelore.memory.folding import fold
from lifelore.memory.location import locate
from lifelore.memory.store import Store, check_source, open_file, open_postgresql, open_source

NAMED = 10
"""Robots that a refusal names."""


def open_memory(where: str | Path | None = None, *, durable: bool = False, read_only: bool = False) -> "Memory":
    """Open a memory, creating it if there is none.

    Parameters
    ----------
    where : str or Path, optional
        A file (its folders are created), or a ``postgresql://`` URL. Default: ``lifelore.db`` in the user's
        data directory.
    durable : bool
        A contribution survives the death of the process at any moment, always. With False (SQLite's
        ``synchronous=NORMAL``) a power loss may take the last few contributions, each as a whole, and never
        damages the file; with True (``FULL``) it takes none, at some milliseconds a contribution.
        A PostgreSQL server decides this by its own settings.
    read_only : bool
        A memory that is there is looked into; none is created, migrated or written to.

    Raises
    ------
    StoreError
        The file is damaged, another program's, of a newer Lifelore, or cannot be written; it stays as it is.
        With `read_only` also where there is none, or one of an older Lifelore.
    InputError
        A URL that is not PostgreSQL's.
    MissingExtraError
        A PostgreSQL URL without psycopg (extra ``postgres``).

    Examples
    --------
    >>> import tempfile
    >>> from lifelore.core.protocols import Record
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/fleet.db") as memory:
    ...     weights = Record("action_prior", "b7", 1, "add", slots=[4, 2], values=[10, 30])
    ...     first = memory.contribute("rosie", [weights], process="p1", seq=0, task={"goal": [3, 4]})
    ...     again = memory.contribute("rosie", [weights], process="p1", seq=0, task={"goal": [3, 4]})
    ...     first, again, memory.tasks("rosie"), memory.recall("action_prior", "b7", 1).values
    (True, False, 1, array([30, 10]))
    """
    place = locate(where)
    if read_only:
        return Memory(open_source(place))
    return Memory(open_file(place, durable=durable) if isinstance(place, Path) else open_postgresql(place))


class Memory:
    """Contributions of robots, merged; made by `open_memory`, closed by `close` or a ``with`` block.

    Any number of processes may use one memory at once: each method is one transaction, writers take turns.
    """

    def __init__(self, store: Store) -> None:
        self._store = store

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let go of file or server; harmless when done twice."""
        self._store.close()

    @property
    def location(self) -> str:
        """The file, or the URL without its password."""
        return self._store.location

    def contribute(
        self, robot: str, records: Sequence[Record], *, process: str, seq: int, task: Mapping[str, Any]
    ) -> bool:
        """Store what a robot learnt from one finished task, all of it or nothing.

        Parameters
        ----------
        robot, process : str
            Who; and which run of it (unique to the run). Printable, 1 to 200 characters.
        records : sequence of Record
            What was learnt; (kind, key, version) differ.
        seq : int
            Which task of the run, from 0.
        task : mapping of str to JSON values
            About the task, for people.

        Returns
        -------
        bool
            False, with nothing changed, when (robot, process, seq) is there already or was forgotten.

        Raises
        ------
        InputError
            A record or name that breaks its rule.
        StoreError
            The disk is full or read-only; a sum beyond 64 bits; a key merged differently before.
        """
        offered = new_contribution(robot, records, process=process, seq=seq, task=task)
        with self._store.writing() as conn:
            if ledger.is_known(conn, offered.identity):
                return False
            cache.write(conn, fold([ledger.insert(conn, offered.stamped(ledger.next_stamp(conn)))]))
        return True

    def recall(self, kind: str, key: str, version: int) -> Record | None:
        """The merged record of all robots, slots ascending, `about` of the newest; None if there is none."""
        with self._store.reading() as conn:
            return cache.read(conn, (kind, key, version))

    def keys(self, kind: str) -> list[tuple[str, int, dict[str, Any]]]:
        """(key, version, about) of all that is known of a kind, sorted."""
        with self._store.reading() as conn:
            return cache.names(conn, kind)

    def tasks(self, robot: str) -> int:
        """How many finished tasks of a robot are remembered; 0 for an unknown robot."""
        count = text("SELECT COUNT(*) FROM lifelore_contributions WHERE robot = :robot")
        with self._store.reading() as conn:
            return int(conn.execute(count, {"robot": robot}).scalar_one())

    def robots(self) -> list[str]:
        """The robots that have contributed, sorted."""
        with self._store.reading() as conn:
            return [entry["robot"] for entry in overview.robots(conn)]

    def show(self) -> dict[str, Any]:
        """What is in here, as plain data: ``location``, ``schema``, ``robots``, ``lore``, ``forgotten``."""
        with self._store.reading() as conn:
            return overview.overview(conn, self.location)

    def export_to(self, path: str | Path) -> int:
        """Write a portable file, itself a memory; the number of contributions in it.

        An earlier export of that name is replaced; any other file there is refused.
        """
        place = locate(path)
        if not isinstance(place, Path):
            raise InputError(f"path must be a file to export to, got {path!r}; use merge_from on the other memory")
        return export(self._store, place)

    def merge_from(self, other: "Memory | str | Path") -> dict[str, int]:
        """Bring in all contributions and tombstones of another memory or export, which stays as it is.

        Returns
        -------
        dict
            ``added``; ``already_there``; ``forgotten`` (kept out or removed here because of a tombstone).

        Raises
        ------
        StoreError
            The other file does not exist, is damaged or newer, or merges a key differently; nothing changed.
        """
        return self.merge_many([other])[0]

    def merge_many(self, others: Sequence["Memory | str | Path"]) -> list[dict[str, int]]:
        """Bring in several memories and exports in one transaction: the same as one by one, only sooner.

        Returns
        -------
        list of dict
            For each of `others` in turn, what `merge_from` returns.

        Raises
        ------
        StoreError
            As for `merge_from`; the message names the source, and nothing of any source was taken.
        """
        if isinstance(others, str):
            raise InputError(f"others must be a list of memories, got the text {others!r}: use merge_from for one")
        places = [other if isinstance(other, Memory) else locate(other) for other in others]
        for place in places:
            if isinstance(place, Path):
                check_source(place)
        with self._store.writing() as here:
            union = merging.MemoryUnion(here)
            counts = [self._take(union, here, place) for place in places]
            union.finish()
        return counts

    def _take(self, union: merging.MemoryUnion, here: Connection, place: "Memory | Path | URL") -> dict[str, int]:
        if isinstance(place, Memory):
            if place.location == self.location:
                return union.take(here, self.location)
            with place._store.reading() as there:
                return union.take(there, place.location)
        if self._store.lies_at(place):
            return union.take(here, self.location)
        with closing(open_source(place, checked=True)) as source, source.reading() as there:
            return union.take(there, source.location)

    def forget(self, robot: str) -> int:
        """Remove all a robot has contributed, for good; the number of contributions removed.

        Tombstones stay, so that no replay, merge or import brings them back; what the robot contributes
        later is taken again.

        Raises
        ------
        NotFoundError
            No such robot.
        """
        with self._store.writing() as conn:
            gone = ledger.entries(conn, robot)
            if not gone:
                known = [entry["robot"] for entry in overview.robots(conn)]
                named = ", ".join(known[:NAMED]) or "none"
                more = f" and {len(known) - NAMED:,} more" if len(known) > NAMED else ""
                raise NotFoundError(f"robot {robot!r} has contributed nothing here; known robots: {named}{more}")
            ledger.bury(conn, [entry.identity for entry in gone])
            merging.remove(conn, gone)
        return len(gone)

    def rebuild(self) -> None:
        """Compute the cache anew from the contributions; changes nothing in a sound memory."""
        with self._store.writing() as conn:
            cache.rebuild(conn)

    def check(self) -> list[str]:
        """Look at every byte: one line for each problem, empty when contributions and cache are sound."""
        with self._store.reading() as conn:
            return audit.problems(conn)
