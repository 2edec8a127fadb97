"""Sums over the rows of a study, and its log as a stream, for reports at any size."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.memory.connection import MANY, Connection

Array = NDArray[Any]


class Sums(NamedTuple):
    """Outcomes by user of a group.

    number, total : (n_users,) int64 and float64, of users with an outcome
    """

    number: Array
    total: Array


class UserHalves(NamedTuple):
    """A row for each user and group with a decision in a window of time.

    person : (n,) float64, number of the user
    control : (n,) float64, 1 in the control group, else 0
    current : (n,) float64, number of decisions by a version of the study
    before, before_sum, after, after_sum : (n,) float64, number and sum of outcomes in the two halves
    """

    person: Array
    control: Array
    current: Array
    before: Array
    before_sum: Array
    after: Array
    after_sum: Array


class StudyTotals:
    """Sums over the rows of a study on a snapshot.

    Parameters
    ----------
    conn : Connection
    number : int
        Of the study.
    """

    def __init__(self, conn: Connection, number: int) -> None:
        self._conn, self._study = conn, number

    def n_decisions(self, *, strangers: bool = False, since: int = 0) -> tuple[int, int]:
        """Number of decisions, and of those without an outcome; parameters as for `by_user`."""
        if strangers or since:
            query = "SELECT COUNT(*), COUNT(outcome) FROM lifelore_decisions WHERE study = ? AND time >= ?"
            n, ended = self._conn.execute(query + self._who(strangers), (self._study, since)).fetchall()[0]
            return int(n), int(n) - int(ended)
        count = "SELECT COUNT(*) FROM lifelore_decisions WHERE study = ?"
        ended = "SELECT COALESCE(SUM(personal + control), 0) FROM lifelore_study_users WHERE study = ?"
        n = int(self._conn.value(count, (self._study,)))
        return n, n - int(self._conn.value(ended, (self._study,)))

    def by_user(self, *, strangers: bool = False, since: int = 0) -> tuple[Sums, Sums]:
        """Outcomes of users chosen for by belief, and of the control group.

        Parameters
        ----------
        strangers : bool
            Whether only users count whom the newest fit did not know.
        since : int
            Only decisions from this time on count, in milliseconds.
        """
        return self._sums("personal", 0, strangers, since), self._sums("control", 1, strangers, since)

    def _sums(self, group: str, control: int, strangers: bool, since: int) -> Sums:
        if since == 0:
            query = (
                f"SELECT {group}, {group}_sum FROM lifelore_study_users WHERE study = ? AND {group} > 0"
                + " AND fitted = 0" * strangers
            )
            return Sums(*_columns(self._conn.stream(query, (self._study,)), 2))
        query = (
            "SELECT COUNT(outcome), SUM(outcome) FROM lifelore_decisions WHERE study = ? AND control = ?"
            f" AND time >= ?{self._who(strangers)} AND outcome IS NOT NULL GROUP BY person"
        )
        return Sums(*_columns(self._conn.stream(query, (self._study, control, since)), 2))

    def control_by_policy(self, *, strangers: bool = False, since: int = 0) -> dict[str, Sums]:
        """Outcomes of the control group by policy and user."""
        timed = " AND time >= ?" if since else ""
        query = (
            "SELECT policy, COUNT(outcome), SUM(outcome) FROM lifelore_decisions WHERE study = ? AND control = 1"
            f"{timed}{self._who(strangers)} AND outcome IS NOT NULL GROUP BY policy, person"
        )
        found: dict[str, list[tuple[int, float]]] = {}
        for rows in self._conn.stream(query, (self._study, since) if since else (self._study,)):
            for policy, number, total in rows:
                found.setdefault(policy, []).append((number, total))
        return {policy: Sums(*np.array(rows, np.float64).T) for policy, rows in found.items()}

    def _who(self, strangers: bool) -> str:
        only = " AND person IN (SELECT number FROM lifelore_study_users WHERE study = {} AND fitted = 0)"
        return only.format(int(self._study)) if strangers else ""

    def n_users(self) -> int:
        """Number of users, also of those whom a log alone names."""
        return int(self._conn.value("SELECT COUNT(*) FROM lifelore_study_users WHERE study = ?", (self._study,)))

    def people(self, *, strangers: bool = False) -> Array:
        """Numbers of all users with an outcome of a decision, or of those whom no fit knew, ascending."""
        query = "SELECT number FROM lifelore_study_users WHERE study = ? AND personal + control > 0"
        found = _columns(self._conn.stream(query + " AND fitted = 0" * strangers, (self._study,)), 1)[0]
        return np.sort(found.astype(np.int64))

    def by_version(self) -> dict[int, int]:
        """Number of decisions by version of the study."""
        query = "SELECT version, COUNT(*) FROM lifelore_decisions WHERE study = ? GROUP BY version"
        return dict(self._conn.execute(query, (self._study,)).fetchall())

    def counts(self, since: int, until: int) -> list[tuple[str, int, int, int, float]]:
        """(policy, control, decisions, outcomes, sum of outcomes) of decisions in [since, until), in milliseconds.

        Decisions of an earlier Lifelore are left out, because their identifiers do not have their times.
        """
        query = (
            "SELECT policy, control, COUNT(*), COUNT(outcome), COALESCE(SUM(outcome), 0) FROM lifelore_decisions"
            " WHERE study = ? AND id >= ? AND id < ? GROUP BY policy, control"
        )
        return self._conn.execute(query, (self._study, first_id(since), first_id(until))).fetchall()

    def halves(self, since: int, middle: int, *, version: int, every: int = 1) -> UserHalves:
        """Decisions and outcomes by user and group since a time, before and after a middle, in milliseconds.

        Parameters
        ----------
        version : int
            Of the study; decisions by it are counted apart.
        every : int
            Users whose number divides by it count: 1 for all.
        """
        query = (
            "SELECT person, control, COUNT(CASE WHEN version = ? THEN 1 END),"
            " COUNT(CASE WHEN id < ? THEN outcome END), COALESCE(SUM(CASE WHEN id < ? THEN outcome END), 0),"
            " COUNT(CASE WHEN id >= ? THEN outcome END), COALESCE(SUM(CASE WHEN id >= ? THEN outcome END), 0)"
            f" FROM lifelore_decisions WHERE study = ? AND id >= ? AND person % {int(every)} = 0"
            " GROUP BY person, control"
        )
        cut = [first_id(middle)] * 4
        parts = self._conn.stream(query, (version, *cut, self._study, first_id(since)))
        rows = np.array([row for part in parts for row in part], np.float64)
        return UserHalves(*rows.reshape(-1, 7).T)

    def log(
        self, columns: Sequence[str], after: bytes = b"", before: bytes | None = None, limit: int = MANY
    ) -> list[tuple[Any, ...]]:
        """The first decisions in order of their identifiers.

        Parameters
        ----------
        columns : sequence of str
            ``d.`` columns of decisions and ``u.`` columns of users.
        after, before : bytes
            Identifiers between the two are given.
        """
        query = (
            f"SELECT {', '.join(columns)} FROM lifelore_decisions d JOIN lifelore_study_users u"
            f" ON u.number = d.person WHERE d.study = ? AND d.id > ?{'' if before is None else ' AND d.id < ?'}"
            " ORDER BY d.id LIMIT ?"
        )
        bounds = [after] if before is None else [after, before]
        return self._conn.execute(query, [self._study, *bounds, limit]).fetchall()


def first_id(time: int) -> bytes:
    """The least identifier of a decision at a time, in milliseconds since 1970."""
    return max(0, time).to_bytes(6, "big") + bytes(10)


def _columns(parts: Iterator[list[tuple[Any, ...]]], n: int) -> tuple[Array, ...]:
    """Columns of numbers from parts of rows."""
    found = [np.array(rows, np.float64).reshape(-1, n) for rows in parts]
    joined = np.concatenate(found) if found else np.empty((0, n))
    return tuple(joined.T)
