"""`Memory`: records of many robots, stored in a file or on a PostgreSQL server."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, closing, contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.protocols import Record
from lifelore.memory import audit, cache, leases, ledger, merging, overview
from lifelore.memory.cache import EVERY_SLOT
from lifelore.memory.connection import Connection
from lifelore.memory.export import export
from lifelore.memory.folding import lift
from lifelore.memory.location import Server, locate
from lifelore.memory.record_blob import pack
from lifelore.memory.record_rules import canonical_json, check_name, check_whole, checked_records
from lifelore.memory.store import Store, check_source, open_existing, open_file, open_postgresql, open_source
from lifelore.memory.studies import Studies

NAMED = 10
"""Maximum number of robots that an error message lists."""


def open_memory(
    where: str | Path | None = None, *, durable: bool = False, read_only: bool = False, create: bool = True
) -> "Memory":
    """Open a memory; create it if there is none.

    Parameters
    ----------
    where : str or Path, optional
        A file in a folder that exists, or a ``postgresql://`` URL. Default: ``lifelore.db`` in the user's
        data directory.
    durable : bool
        With False (SQLite's ``synchronous=NORMAL``) a power loss may lose the last few contributions, each
        completely, and never damages the file. With True (``FULL``) it loses none, and each contribution takes
        some milliseconds more. A killed process loses none in both cases. A PostgreSQL server decides this by
        its own settings.
    read_only : bool
        Only read an existing memory; do not create, migrate or write to one.
    create : bool
        With False the memory must exist. If its file or folder cannot be written, it is opened only for reading.

    Raises
    ------
    StoreError
        The file is damaged, belongs to another program or a newer Lifelore, or cannot be written; it is not
        changed. With `read_only` also if there is no memory, or one of an older Lifelore. With ``create=False``
        also if there is no memory.
    InputError
        The URL is not one of PostgreSQL.
    MissingExtraError
        A PostgreSQL URL needs psycopg (extra ``postgres``).

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
    if not create:
        if where is None and isinstance(place, Path) and not place.exists():
            raise StoreError(f"there is no memory yet: the first life creates {place}; name another with --memory")
        return Memory(open_existing(place, durable=durable))
    return Memory(open_file(place, durable=durable) if isinstance(place, Path) else open_postgresql(place))


class Memory:
    """Merged contributions of robots; opened by `open_memory`, closed by `close` or a ``with`` block.

    Several processes may use one memory at the same time. Each method is one transaction; one process writes at a
    time.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore.core.protocols import Record
    >>> goals = Record("goal_counts", "office", 1, "add", slots=[3, 7], values=[1, 2])
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/fleet.db") as memory:
    ...     stored = [memory.contribute("rosie", [goals], process="p", seq=task, task={}) for task in (0, 1)]
    ...     memory.recall("goal_counts", "office", 1).values.tolist()
    [2, 4]
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
        """Close the file or connection; a second call does nothing."""
        self._store.close()

    @property
    def studies(self) -> Studies:
        """The studies of personalisation, which are tables of their own."""
        return Studies(self._store)

    @property
    def location(self) -> str:
        """The file, or the URL without its password."""
        return self._store.location

    def contribute(
        self,
        robot: str,
        records: Sequence[Record],
        *,
        process: str,
        seq: int,
        task: Mapping[str, Any],
        taken: int | None = None,
    ) -> bool:
        """Store the records of a robot about one finished task, all or none.

        Parameters
        ----------
        robot, process : str
            Names of the robot and of its run; unique to the run. Printable, 1 to 200 characters.
        records : sequence of Record
            Their (kind, key, version) must differ.
        seq : int
            Number of the task in the run, from 0.
        task : mapping of str to JSON values
            Description of the task for readers.
        taken : int, optional
            Number of the task, if the process took it by `take_task`. The contribution ends the lease.

        Returns
        -------
        bool
            False if (robot, process, seq) is already stored or was forgotten, or if the lease of `taken` has ended
            and another process has taken the task; then nothing changes.

        Raises
        ------
        InputError
            A record or name breaks its rule.
        StoreError
            The disk is full or read-only, a sum exceeds 64 bits, or the key has another merge.
        """
        identity = check_name("robot", robot), check_name("process", process), check_whole("seq", seq)
        described, checked = canonical_json("task", task), checked_records(records)
        payload = pack(checked)
        with self._store.writing() as conn:
            if taken is not None and not leases.finish(conn, identity, taken):
                return False
            number = ledger.insert(conn, identity, described, payload)
            if number is not None:
                cache.write(conn, lift(number, checked))
        return number is not None

    def take_task(self, robot: str, *, process: str, seconds: int = leases.LEASE_SECONDS) -> int:
        """Take the next task of a robot that is neither finished nor at work in another process.

        The lease of the task ends when the process contributes it (``contribute(..., taken=NUMBER)``), gives it
        back, dies on this machine, or after some time; a task that was not finished is then taken again.

        Parameters
        ----------
        robot, process : str
            As for `contribute`.
        seconds : int
            Time until other processes may take the task, unless it is finished before.

        Returns
        -------
        int
            Number of the task, from 0. Without other processes it is that of `tasks`.

        Examples
        --------
        >>> import tempfile
        >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/fleet.db") as memory:
        ...     first, second = (memory.take_task("rosie", process=name) for name in ("p1", "p2"))
        ...     done = memory.contribute("rosie", [], process="p2", seq=0, task={}, taken=second)
        ...     memory.give_back_task("rosie", first, process="p1")
        ...     first, second, done, memory.take_task("rosie", process="p2")
        (0, 1, True, 0)
        """
        names = check_name("robot", robot), check_name("process", process)
        seconds = check_whole("seconds", seconds, smallest=1)
        with self._store.writing() as conn:
            return leases.take(conn, *names, seconds)

    def give_back_task(self, robot: str, number: int, *, process: str) -> None:
        """End the lease of a task that was not finished, so that it is the next to be taken."""
        with self._store.writing() as conn:
            leases.give_back(conn, robot, process, number)

    @contextmanager
    def taken_task(self, robot: str, *, process: str) -> Iterator[int]:
        """A block with a task of `take_task`, which is given back if the block ends by an error."""
        number = self.take_task(robot, process=process)
        try:
            yield number
        except BaseException:
            # The error in progress is the one to report.
            with suppress(StoreError):
                self.give_back_task(robot, number, process=process)
            raise

    def together(self, *, rows: bool = False) -> AbstractContextManager[None]:
        """A block in which all that this thread reads and stores is one transaction, stored when the block ends.

        Many small contributions then wait for the disk once. A contribution that fails inside the block leaves
        the others as they are. An error that leaves the block undoes all of them.

        Parameters
        ----------
        rows : bool
            Whether the block changes rows of studies alone. On a PostgreSQL server such blocks run side by side.

        Raises
        ------
        StoreError
            The end of the block: the disk refuses; nothing of the block was stored.
        """
        return self._store.together(rows=rows)

    def recall(self, kind: str, key: str, version: int, *, slots: tuple[int, int] = EVERY_SLOT) -> Record | None:
        """The merged record of all robots, slots ascending, with the newest ``about``; None if there is none.

        Parameters
        ----------
        slots : (int, int), optional
            First and last slot to read; a few slots of a large record cost no more than a small record.
        """
        with self._store.reading() as conn:
            return cache.read(conn, (kind, key, version), slots)

    def keys(self, kind: str) -> list[tuple[str, int, dict[str, Any]]]:
        """(key, version, about) of all records of a kind, sorted."""
        with self._store.reading() as conn:
            return cache.names(conn, kind)

    def tasks(self, robot: str) -> int:
        """Number of stored tasks of a robot; 0 for an unknown robot."""
        count = "SELECT COUNT(*) FROM lifelore_contributions WHERE robot = ?"
        with self._store.reading() as conn:
            return int(conn.value(count, (robot,)))

    def task_descriptions(self, robot: str) -> Iterator[dict[str, Any]]:
        """The descriptions of a robot's stored tasks, the newest first."""
        query = "SELECT task FROM lifelore_contributions WHERE robot = ? ORDER BY stamp DESC"
        with self._store.reading() as conn:
            rows = conn.execute(query, (robot,)).fetchall()
        for (text,) in rows:
            yield json.loads(text)

    def robots(self) -> list[str]:
        """The robots that have contributed, sorted."""
        with self._store.reading() as conn:
            return [entry["robot"] for entry in overview.robots(conn)]

    def revision(self) -> str:
        """A text that differs after each change of the content by any process; it costs no look at the content."""
        with self._store.reading() as conn:
            return overview.revision(conn)

    def show(self) -> dict[str, Any]:
        """Content of the memory as JSON data: ``location``, ``schema``, ``robots``, ``lore``, ``forgotten``."""
        with self._store.reading() as conn:
            return overview.overview(conn, self.location)

    def export_to(self, path: str | Path) -> int:
        """Write a portable file, itself a memory; return the number of its contributions.

        An earlier export of this name is replaced; any other existing file is an error.
        """
        place = locate(path)
        if not isinstance(place, Path):
            raise InputError(f"path must be a file to export to, got {path!r}; use merge_from on the other memory")
        return export(self._store, place)

    def merge_from(self, other: "Memory | str | Path") -> dict[str, int]:
        """Copy all contributions and tombstones of another memory or export, which is not changed.

        What records mean is not looked at: types that two robots of one name have named alike become one type,
        where ``lifelore memory merge`` refuses. Robots that live apart need names of their own.

        Returns
        -------
        dict
            ``added``; ``already_there``; ``forgotten`` (not added, or removed here, because of a tombstone).

        Raises
        ------
        StoreError
            The other file does not exist, is damaged or newer, or has another merge for a key; nothing changes.
        """
        return self.merge_many([other])[0]

    def merge_many(self, others: Sequence["Memory | str | Path"]) -> list[dict[str, int]]:
        """Copy several memories and exports in one transaction: as `merge_from` for each, but faster.

        Returns
        -------
        list of dict
            For each of `others` in turn, what `merge_from` returns.

        Raises
        ------
        StoreError
            As for `merge_from`; the message names the source, and nothing of any source is copied.
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

    def _take(
        self, union: merging.MemoryUnion, here: Connection, place: "Memory | Path | Server"
    ) -> dict[str, int]:
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
        """Remove all contributions of a robot for ever; return their number.

        Tombstones stay, so that no replay, merge or import restores them. Later contributions of the robot are
        stored again. An SQLite file and its log hold no byte of the contributions afterwards; the names of robots
        and processes stay in the tombstones. A PostgreSQL server deletes rows, and their bytes stay in its files
        until ``VACUUM FULL``, in its log and backups until these expire.

        Raises
        ------
        NotFoundError
            The robot has no contributions.
        StoreError
            The robot is forgotten, but another process reads the file, so that the log still holds the bytes.
        """
        with self._store.writing() as conn:
            if not ledger.entries(conn, robot):
                known = [entry["robot"] for entry in overview.robots(conn)]
                named = ", ".join(known[:NAMED]) or "none"
                more = f" and {len(known) - NAMED:,} more" if len(known) > NAMED else ""
                raise NotFoundError(f"robot {robot!r} has contributed nothing here; known robots: {named}{more}")
            count = _forget(conn, [robot])
        self._store.empty_log()
        return count

    def forget_all(self, robots: Sequence[str]) -> int:
        """`forget` several robots in one transaction; those that have contributed nothing are passed over."""
        with self._store.writing() as conn:
            count = _forget(conn, robots)
        self._store.empty_log()
        return count

    def forget_tasks(self, chosen: Callable[[str, Mapping[str, Any]], bool]) -> int:
        """Remove for ever the contributions whose robot and task description are `chosen`; return their number.

        No replay, merge or import restores them, and bytes go as in `forget`.
        """
        with self._store.writing() as conn:
            found = [one for one in ledger.tasks(conn) if chosen(one[1][0], json.loads(one[2]))]
            if not found:
                return 0
            ledger.add_tombstones(conn, [identity for _, identity, _ in found])
            cache.rebuild(conn, merging.delete(conn, [number for number, _, _ in found]))
        self._store.empty_log()
        return len(found)

    def is_known(self, robot: str, process: str, seq: int) -> bool:
        """Whether the memory stores a contribution, or has forgotten it."""
        with self._store.reading() as conn:
            return ledger.is_known(conn, (robot, process, seq))

    def times_forgotten(self, robot: str, process: str) -> int:
        """Number of forgotten contributions of a process of a robot."""
        count = "SELECT COUNT(*) FROM lifelore_tombstones WHERE robot = ? AND process = ?"
        with self._store.reading() as conn:
            return int(conn.value(count, (robot, process)))

    def forget_records(self, names: Sequence[tuple[str, str, int]]) -> int:
        """Remove the records of some (kind, key, version) for ever; return the number of contributions concerned.

        The other records of these contributions stay. No replay, merge or import restores the records. Records of
        these keys that are contributed later are stored again. The bytes go as in `forget`; the keys stay.

        Raises
        ------
        NotFoundError
            No record has one of these keys.
        StoreError
            As for `forget`.
        """
        with self._store.writing() as conn:
            touched: set[int] = set()
            for name in names:
                if not (mentions := cache.mentions(conn, name)):
                    raise NotFoundError(f"record {name[0]}/{name[1]} version {name[2]} is not in this memory")
                touched |= mentions
            stamp = ledger.next_stamp(conn)
            cache.rebuild(conn, merging.forget_records(conn, dict.fromkeys(names, stamp)))
        self._store.empty_log()
        return len(touched)

    def rebuild(self) -> None:
        """Compute the cache again from the contributions; changes nothing in a sound memory."""
        with self._store.writing() as conn:
            cache.rebuild(conn)

    def check(self) -> list[str]:
        """Check every byte; return one line for each problem, none if contributions and cache are sound."""
        with self._store.reading() as conn:
            return audit.problems(conn)


def _forget(conn: Connection, robots: Sequence[str]) -> int:
    """Delete the contributions of robots, and leave tombstones; the number of contributions."""
    forgotten = [entry for robot in robots for entry in ledger.entries(conn, robot)]
    ledger.add_tombstones(conn, [entry.identity for entry in forgotten])
    for robot in robots:
        leases.forget(conn, robot)
    cache.rebuild(conn, merging.delete(conn, [entry.number for entry in forgotten]))
    return len(forgotten)
