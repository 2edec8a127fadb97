"""Studies of personalisation as tables: library versions, users, their past, decisions with their outcomes.

    lifelore_studies          a name, its state (active or archived), the number of its newest version
    lifelore_study_versions   what a fit or a registration has made: settings as JSON, the library's file
    lifelore_study_users      a row each: context, features, named type, belief, sums of outcomes by group
    lifelore_study_past       outcomes that users had elsewhere, each line once
    lifelore_decisions        a row each: policy, probability, group, and the outcome beside it

Studies are rows and no lore: merges and exports leave them out. `study_rows` has what a transaction does with
users and decisions, `study_totals` the sums and the log that a report reads.
"""

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

from lifelore.memory.store import Store
from lifelore.memory.study_rows import StudyRows
from lifelore.memory.study_totals import StudyTotals

ACTIVE, ARCHIVED = "active", "archived"
TABLES = ("lifelore_decisions", "lifelore_study_past", "lifelore_study_users", "lifelore_study_versions")
"""All tables with a column ``study``."""

_MAKE = (
    "INSERT INTO lifelore_studies (name, state, version, revision) VALUES (?, ?, 0, 0)"
    " ON CONFLICT (name) DO NOTHING"
)
_CHANGE = "UPDATE lifelore_studies SET revision = revision + 1 WHERE name = ? RETURNING number, state, version"


class StudyVersion(NamedTuple):
    """The newest version of a study.

    number : of the study in its tables
    state : "active" or "archived"
    version : from 1
    about : dict, its settings
    content : bytes, its library
    """

    number: int
    state: str
    version: int
    about: dict[str, Any]
    content: bytes


class Studies:
    """The studies in a memory.

    Parameters
    ----------
    store : Store
    """

    def __init__(self, store: Store) -> None:
        self._store = store

    def states(self) -> dict[str, str]:
        """The state of each study by its name, sorted."""
        with self._store.reading() as conn:
            found: list[tuple[str, str]] = conn.execute("SELECT name, state FROM lifelore_studies").fetchall()
        return dict(sorted(found))

    def revision(self, name: str) -> int | None:
        """A number that differs after each change of a study by any process; None where there is no such study."""
        with self._store.reading() as conn:
            found = conn.first("SELECT revision FROM lifelore_studies WHERE name = ?", (name,))
        return None if found is None else int(found[0])

    def newest(self, name: str) -> StudyVersion | None:
        """The newest version; None where there is no such study."""
        query = (
            "SELECT number, state, s.version, about, content FROM lifelore_studies s"
            " JOIN lifelore_study_versions v ON v.study = number AND v.version = s.version WHERE name = ?"
        )
        with self._store.reading() as conn:
            found = conn.first(query, (name,))
        if found is None:
            return None
        number, state, version, about, content = found
        return StudyVersion(number, state, version, json.loads(about), content)

    def settings(self, number: int) -> dict[int, dict[str, Any]]:
        """The settings of each version of a study."""
        query = "SELECT version, about FROM lifelore_study_versions WHERE study = ?"
        with self._store.reading() as conn:
            return {version: json.loads(about) for version, about in conn.execute(query, (number,)).fetchall()}

    def keep(
        self, name: str, about: Mapping[str, Any], content: bytes, *, free: Sequence[str] = ()
    ) -> StudyVersion:
        """Store a study: as another version, or in place of the newest one where nothing else than `free` differs.

        Parameters
        ----------
        about : mapping
            Settings, as JSON.
        content : bytes
            The library.
        free : sequence of str
            Settings that a version does not depend on.
        """
        with self._store.writing() as conn:
            conn.execute(_MAKE, (name, ACTIVE))
            number, state, version = conn.execute(_CHANGE, (name,)).fetchall()[0]
            query = "SELECT about, content FROM lifelore_study_versions WHERE study = ? AND version = ?"
            before = conn.first(query, (number, version))
            text = json.dumps(about)
            if before is not None and bytes(before[1]) == content:
                earlier, now = json.loads(before[0]), json.loads(text)
                if all(earlier.get(key) == now[key] for key in now if key not in free):
                    query = "UPDATE lifelore_study_versions SET about = ? WHERE study = ? AND version = ?"
                    conn.execute(query, (text, number, version))
                    return StudyVersion(number, state, version, now, content)
            version += 1
            conn.execute("UPDATE lifelore_studies SET version = ? WHERE number = ?", (version, number))
            columns = ("study", "version", "created", "about", "content")
            conn.insert(
                "lifelore_study_versions", columns, [(number, version, time.time_ns() // 10**6, text, content)]
            )
        return StudyVersion(number, state, version, json.loads(text), content)

    def set_state(self, name: str, state: str) -> bool:
        """Archive a study or make it active again; whether there is one."""
        statement = (
            "UPDATE lifelore_studies SET state = ?, revision = revision + 1 WHERE name = ? RETURNING number"
        )
        with self._store.writing() as conn:
            return conn.first(statement, (state, name)) is not None

    def delete(self, name: str) -> bool:
        """Delete a study with all its rows for ever; whether there was one."""
        with self._store.writing() as conn:
            found = conn.first("SELECT number FROM lifelore_studies WHERE name = ?", (name,))
            if found is None:
                return False
            for table in TABLES:
                conn.execute(f"DELETE FROM {table} WHERE study = ?", found)
            conn.execute("DELETE FROM lifelore_studies WHERE number = ?", found)
        self._store.empty_log()
        return True

    @contextmanager
    def writing(self, number: int) -> Iterator[StudyRows]:
        """A transaction that changes rows of a study; it locks the users that it asks to lock."""
        with self._store.writing(rows=True) as conn:
            yield StudyRows(conn, number)

    @contextmanager
    def reading(self, number: int) -> Iterator[StudyRows]:
        """A transaction on a snapshot."""
        with self._store.reading() as conn:
            yield StudyRows(conn, number)

    @contextmanager
    def totals(self, number: int) -> Iterator[StudyTotals]:
        """Sums and streams on a snapshot."""
        with self._store.reading() as conn:
            yield StudyTotals(conn, number)

    def forgotten(self) -> None:
        """Leave no byte of deleted rows behind in the log of an SQLite file, see `Store.empty_log`."""
        self._store.empty_log()
