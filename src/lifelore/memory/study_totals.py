"""Sums over the rows of a study, and its log as a stream, for reports at any size."""

from collections.abc import Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.memory.connection import MANY, Connection

Array = NDArray[Any]


class UserSums(NamedTuple):
    """Outcomes by user, (n_users,) float64 each.

    person : number of the user
    personal, personal_sum : number and sum of outcomes that were chosen by belief
    control, control_sum : number and sum of outcomes in the control group
    """

    person: Array
    personal: Array
    personal_sum: Array
    control: Array
    control_sum: Array


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

    def any_before(self, time: int) -> bool:
        """Whether there is a decision before a time, in milliseconds since 1970."""
        # Identifiers are in the order of their times, but for those of an earlier Lifelore, which come first.
        query = "SELECT 1 FROM lifelore_decisions WHERE study = ? AND id < ? AND time < ? LIMIT 1"
        return self._conn.first(query, (self._study, first_id(time), time)) is not None

    def by_user(self, *, strangers: bool = False, since: int = 0) -> UserSums:
        """Outcomes of all users with one.

        Parameters
        ----------
        strangers : bool
            Whether only users count whom the newest fit did not know.
        since : int
            Only decisions from this time on count, in milliseconds.
        """
        if since == 0:
            query = (
                "SELECT number, personal, personal_sum, control, control_sum FROM lifelore_study_users"
                f" WHERE study = ? AND personal + control > 0{' AND fitted = 0' * strangers}"
            )
            return UserSums(*self._columns(query, (self._study,), 5))
        query = (
            "SELECT person, SUM(1 - control), SUM((1 - control) * outcome), SUM(control), SUM(control * outcome)"
            f" FROM lifelore_decisions WHERE study = ? AND time >= ?{self._who(strangers)}"
            " AND outcome IS NOT NULL GROUP BY person"
        )
        return UserSums(*self._columns(query, (self._study, since), 5))

    def control_means(self, policy: str, *, strangers: bool = False, since: int = 0) -> Array:
        """Mean outcome of a policy for each user of the control group who got it, (n_users,)."""
        timed = " AND time >= ?" if since else ""
        query = (
            "SELECT AVG(outcome) FROM lifelore_decisions WHERE study = ? AND control = 1 AND policy = ?"
            f"{timed}{self._who(strangers)} AND outcome IS NOT NULL GROUP BY person"
        )
        return self._columns(query, (self._study, policy, since)[: 3 if since else 2], 1)[0]

    def next_time(self, since: int, *, strangers: bool = False) -> int | None:
        """Time of the first decision from a time on, both in milliseconds.

        Decisions of an earlier Lifelore are left out, because their identifiers do not have their times.
        """
        # PostgreSQL before 18 has no least of bytes.
        query = (
            f"SELECT id FROM lifelore_decisions WHERE study = ? AND id >= ?{self._who(strangers)}"
            " ORDER BY id LIMIT 1"
        )
        found = self._conn.first(query, (self._study, first_id(max(since, 1))))
        return None if found is None else int.from_bytes(found[0][:6], "big")

    def within(self, since: int, until: int, *, strangers: bool = False) -> Array:
        """Decisions in [since, until), in milliseconds, by user and group, (4, n) float64.

        The rows are: 1 for the control group, numbers of decisions and of outcomes, and the sum of these.
        Decisions of an earlier Lifelore are left out.
        """
        query = (
            "SELECT control, COUNT(*), COUNT(outcome), COALESCE(SUM(outcome), 0) FROM lifelore_decisions"
            f" WHERE study = ? AND id >= ? AND id < ?{self._who(strangers)} GROUP BY control, person"
        )
        return self._columns(query, (self._study, first_id(max(since, 1)), first_id(until)), 4)

    def _who(self, strangers: bool) -> str:
        only = " AND person IN (SELECT number FROM lifelore_study_users WHERE study = {} AND fitted = 0)"
        return only.format(int(self._study)) if strangers else ""

    def _columns(self, query: str, parameters: Sequence[Any], n: int) -> Array:
        """Columns of numbers of a statement, (n, n_rows) float64."""
        parts = [
            np.fromiter(chain.from_iterable(rows), np.float64, n * len(rows)).reshape(-1, n)
            for rows in self._conn.stream(query, parameters)
        ]
        return np.concatenate(parts).T if parts else np.empty((n, 0))

    def n_users(self) -> int:
        """Number of users, also of those whom a log alone names."""
        return int(self._conn.value("SELECT COUNT(*) FROM lifelore_study_users WHERE study = ?", (self._study,)))

    def counts(self, since: int, until: int) -> list[tuple[str, int, int, int, float]]:
        """(policy, control, decisions, outcomes, sum of outcomes) of decisions, as for `within`."""
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
        return UserHalves(*self._columns(query, (version, *cut, self._study, first_id(since)), 7))

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
