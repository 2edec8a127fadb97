"""What a transaction does with the users, past and decisions of a study."""

import json
from collections.abc import Iterable, Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

from lifelore.memory.connection import Connection

_FIELDS = "number, name, context, features, type, fitted, version, state, "
_USER = _FIELDS + "0"
# Decisions of earlier schemas have no turn, so they are counted before the first one that has.
_COUNTED = _FIELDS + (
    "COALESCE((SELECT MAX(turn) + 1 FROM lifelore_decisions WHERE person = u.number),"
    " (SELECT COUNT(*) FROM lifelore_decisions WHERE person = u.number))"
)


class UserRow(NamedTuple):
    """A user of a study.

    number : in the tables
    context, features, type : str, dict and str, as last named; None where nobody named them
    fitted : whether the newest fit knew the user
    version : of the study that the belief is of
    state : bytes, the belief; None: before the first outcome
    n_decisions : as far as it was asked for
    """

    number: int
    name: str
    context: str | None
    features: dict[str, float] | None
    type: str | None
    fitted: bool
    version: int
    state: bytes | None
    n_decisions: int = 0


class DecisionRow(NamedTuple):
    """A stored decision.

    id : 16 bytes
    person : number of its user
    time, ended : milliseconds since 1970; `ended` is None while the outcome is not known
    control : whether the user was held out
    available : the policies that were available; None: all
    turn : number of decisions for the user before; None: not known, or not read
    """

    id: bytes
    person: int
    policy: str
    probability: float
    control: bool
    version: int
    time: int
    context: str | None = None
    available: tuple[str, ...] | None = None
    request: str | None = None
    outcome: float | None = None
    ended: int | None = None
    turn: int | None = None


_DECISION = ", ".join(DecisionRow._fields[:-1])
"""Columns of a decision that are read; the turn is only for the next one."""
_MADE = (*DecisionRow._fields[: DecisionRow._fields.index("outcome")], "turn")
"""Columns of a decision without its outcome."""


class PastRow(NamedTuple):
    """An outcome that a user had elsewhere.

    id : 16 bytes, the identity of its line
    time : milliseconds since 1970; 0: not known
    fitted : whether a fit read it
    """

    id: bytes
    person: int
    policy: str
    outcome: float
    time: int
    fitted: bool


class StudyRows:
    """The rows of a study inside a transaction.

    Whatever changes several users does so in the order of their numbers, or of their names where they are new, so
    that two transactions of a PostgreSQL server never wait for each other. Numbers of users are unique in a
    memory: where they are given, ``+study`` keeps SQLite from reading the whole study to find a few users.

    Parameters
    ----------
    conn : Connection
    number : int
        Of the study.
    """

    def __init__(self, conn: Connection, number: int) -> None:
        self._conn, self._study = conn, number

    # ---- users -------------------------------------------------------------------------------------------

    def users(self, names: Sequence[str], *, lock: bool = False, count: bool = False) -> dict[str, UserRow]:
        """The known users among `names`.

        With `lock` nobody deletes them before the transaction ends; with `count` their decisions are counted.
        """
        query = (
            f"SELECT {_COUNTED if count else _USER} FROM lifelore_study_users u"
            " WHERE study = ? AND name IN ({many})"
        )
        found = self._conn.matching(query + self._locked(lock, "KEY SHARE"), names, (self._study,))
        return {row[1]: _user(row) for row in found}

    def numbered(self, numbers: Iterable[int], *, lock: bool = False) -> dict[int, UserRow]:
        """Users by number; with `lock` no other transaction changes them before this one ends.

        Lock all users of a transaction by a single call, which does so in the order of their numbers: transactions
        that lock the same users in different orders would wait for one another.
        """
        query = (
            f"SELECT {_USER} FROM lifelore_study_users WHERE +study = ? AND number IN ({{many}}) ORDER BY number"
        )
        how = self._locked(lock, "NO KEY UPDATE")
        found = self._conn.matching(query + how, sorted(set(numbers)), (self._study,))
        return {row[0]: _user(row) for row in found}

    def add_users(
        self, users: Sequence[tuple[str, str | None, Mapping[str, float] | None]], version: int
    ) -> dict[str, UserRow]:
        """Add users (name, context, features) before their first outcome; all by name, locked as by `users`.

        Users whom another program has added meanwhile stay as they are.
        """
        types = {
            "study": "bigint", "name": "text", "context": "text", "features": "text", "fitted": "bigint",
            "version": "bigint", "personal": "bigint", "personal_sum": "float8", "control": "bigint",
            "control_sum": "float8",
        }  # fmt: skip
        rows = [
            (self._study, name, context, _json(features), 0, version, 0, 0, 0, 0)
            for name, context, features in sorted(users, key=itemgetter(0))
        ]
        added = self._conn.insert_unless_there("lifelore_study_users", types, rows, "study, name", _USER)
        found = {row[1]: _user(row) for row in added}
        others = [row[1] for row in rows if row[1] not in found]
        return found | self.users(others, lock=True) if others else found

    def rename(self, names: Mapping[int, str]) -> None:
        """Give users other names, by their numbers."""
        self._change_users("name = {name}", {"name": "text"}, names.items())

    def describe(self, users: Iterable[tuple[int, str | None, Mapping[str, float] | None, str | None]]) -> None:
        """Set (number, context, features, type) of users, whose beliefs must then be computed again."""
        self._change_users(
            "context = {context}, features = {features}, type = {type}, version = 0",
            {"context": "text", "features": "text", "type": "text"},
            ((number, context, _json(features), type_) for number, context, features, type_ in users),
        )

    def keep_beliefs(self, beliefs: Iterable[tuple[int, bytes | None]], version: int) -> None:
        """Store the beliefs about users by number."""
        setting = f"state = {{state}}, version = {int(version)}"
        self._change_users(setting, {"state": "bytea"}, beliefs)

    def learn(self, learnt: Iterable[tuple[int, bytes | None, int, float, int, float]], version: int) -> None:
        """Store beliefs of locked users, and add outcomes to their sums.

        Parameters
        ----------
        learnt : (number, belief, number and sum of outcomes chosen by belief, and of the control group)
        """
        self._change_users(
            f"state = {{state}}, version = {int(version)}, personal = personal + {{personal}},"
            " personal_sum = personal_sum + {personal_sum}, control = control + {control},"
            " control_sum = control_sum + {control_sum}",
            {"state": "bytea", "personal": "bigint", "personal_sum": "float8", "control": "bigint",
             "control_sum": "float8"},
            learnt,
            locked=True,
        )  # fmt: skip

    def _change_users(
        self, setting: str, types: Mapping[str, str], users: Iterable[Sequence[Any]], *, locked: bool = False
    ) -> None:
        """Set columns of users, each given by number and values."""
        rows = sorted(users, key=itemgetter(0))
        if not (locked or self._conn.is_sqlite):
            query = (
                "SELECT number FROM lifelore_study_users WHERE +study = ? AND number IN ({many}) ORDER BY number"
            )
            self._conn.matching(f"{query} FOR NO KEY UPDATE", [row[0] for row in rows], (self._study,))
        where = f"study = {int(self._study)} AND number = {{number}}"
        self._conn.change("lifelore_study_users", setting, where, {"number": "bigint", **types}, rows)

    def forget(self, number: int) -> int | None:
        """Delete a user with everything stored; the number of decisions and lines of the past deleted.

        None where another transaction has deleted the user before.
        """
        # First the user: that waits for transactions that are about to store decisions for the user.
        counts = [
            len(
                self._conn.execute(
                    f"DELETE FROM {table} WHERE +study = ? AND {column} = ? RETURNING study", (self._study, number)
                ).fetchall()
            )
            for table, column in (
                ("lifelore_study_users", "number"),
                ("lifelore_decisions", "person"),
                ("lifelore_study_past", "person"),
            )
        ]
        return sum(counts[1:]) if counts[0] else None

    def _locked(self, lock: bool, how: str) -> str:
        return f" FOR {how}" if lock and not self._conn.is_sqlite else ""

    # ---- decisions -----------------------------------------------------------------------------------------

    def add_decisions(self, decisions: Iterable[DecisionRow]) -> None:
        """Store new decisions, without their outcomes."""
        rows = [
            (self._study, *one[:4], int(one.control), *one[5:8], _json(one.available), one.request, one.turn)
            for one in decisions
        ]
        self._conn.insert("lifelore_decisions", ("study", *_MADE), rows)

    def locked_decisions(self, ids: Sequence[bytes]) -> tuple[dict[bytes, DecisionRow], dict[int, UserRow]]:
        """Decisions by identifier and their users by number, whom no other transaction changes before the end."""
        found = self.decisions(ids)
        users = self.numbered((one.person for one in found.values()), lock=True)
        if not self._conn.is_sqlite:  # another program may have taken an outcome before the users were locked
            found = self.decisions(ids)
        return {id_: one for id_, one in found.items() if one.person in users}, users

    def decisions(self, ids: Sequence[bytes]) -> dict[bytes, DecisionRow]:
        """The decisions with some of these identifiers."""
        query = f"SELECT {_DECISION} FROM lifelore_decisions WHERE study = ? AND id IN ({{many}})"
        return {row.id: row for row in map(_decision, self._conn.matching(query, ids, (self._study,)))}

    def decisions_of(self, numbers: Sequence[int]) -> dict[int, list[DecisionRow]]:
        """All decisions for users by their number, in order of time."""
        query = f"SELECT {_DECISION} FROM lifelore_decisions WHERE +study = ? AND person IN ({{many}})"
        found: dict[int, list[DecisionRow]] = {}
        rows = map(_decision, self._conn.matching(query, numbers, (self._study,)))
        for row in sorted(rows, key=lambda row: (row.time, row.id)):
            found.setdefault(row.person, []).append(row)
        return found

    def first_decisions(self, numbers: Sequence[int]) -> dict[int, int]:
        """Time of the first decision for each user that had one, in milliseconds since 1970."""
        query = (
            "SELECT person, MIN(time) FROM lifelore_decisions WHERE +study = ? AND person IN ({many})"
            " GROUP BY person"
        )
        return dict(self._conn.matching(query, numbers, (self._study,)))

    def requested(self, pairs: Sequence[tuple[int, str | None]]) -> dict[tuple[int, str | None], DecisionRow]:
        """The decisions that were made for (user, request)."""
        query = (
            f"SELECT {_DECISION} FROM (VALUES {{many}}) AS asked CROSS JOIN lifelore_decisions"
            " WHERE person = column1 AND request = column2 AND request IS NOT NULL"
        )
        found = map(_decision, self._conn.matching_rows(query, pairs))
        return {(row.person, row.request): row for row in found}

    def end_decisions(self, outcomes: Iterable[tuple[bytes, float, int]]) -> None:
        """Store (identifier, outcome, time in milliseconds) of decisions that have no outcome."""
        self._conn.change(
            "lifelore_decisions", "outcome = {outcome}, ended = {ended}",
            f"study = {int(self._study)} AND id = {{id}} AND outcome IS NULL",
            {"id": "bytea", "outcome": "float8", "ended": "bigint"}, list(outcomes),
        )  # fmt: skip

    # ---- evidence ------------------------------------------------------------------------------------------

    def evidence(self, numbers: Sequence[int]) -> list[tuple[int, str, float]]:
        """(user, policy, outcome) of all that users' beliefs follow from: the past, then outcomes as they came."""
        past = [(number, *pair) for number, own in self.past_of(numbers).items() for pair in own]
        query = (
            "SELECT person, policy, outcome, ended, id FROM lifelore_decisions"
            " WHERE +study = ? AND outcome IS NOT NULL AND person IN ({many})"
        )
        found = self._conn.matching(query, numbers, (self._study,))
        return past + [row[:3] for row in sorted(found, key=lambda row: row[3:])]

    def past_of(self, numbers: Sequence[int]) -> dict[int, list[tuple[str, float]]]:
        """(policy, outcome) of the past of users by their number, in order of time."""
        query = (
            "SELECT person, policy, outcome, time, id FROM lifelore_study_past"
            " WHERE +study = ? AND person IN ({many})"
        )
        found: dict[int, list[tuple[str, float]]] = {}
        for person, policy, outcome, *_ in sorted(
            self._conn.matching(query, numbers, (self._study,)), key=lambda row: row[3:]
        ):
            found.setdefault(person, []).append((policy, outcome))
        return found

    def add_past(self, lines: Iterable[PastRow]) -> None:
        """Store lines of the past, each identity once."""
        statement = (
            "INSERT INTO lifelore_study_past (study, id, person, policy, outcome, time, fitted)"
            " VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT (study, id) DO NOTHING"
        )
        self._conn.execute_many(statement, [(self._study, *line[:5], int(line.fitted)) for line in sorted(lines)])

    def known_past(self, ids: Sequence[bytes]) -> set[bytes]:
        """Which of these identities are in the past."""
        query = "SELECT id FROM lifelore_study_past WHERE study = ? AND id IN ({many})"
        return {row[0] for row in self._conn.matching(query, ids, (self._study,))}

    def begin_fit(self) -> None:
        """Delete the lines that an earlier fit read, and mark no user as known to a fit."""
        own = (self._study,)
        self._conn.execute("DELETE FROM lifelore_study_past WHERE study = ? AND fitted = 1", own)
        self._conn.execute("UPDATE lifelore_study_users SET fitted = 0, version = 0 WHERE study = ?", own)

    def mark_fitted(self, numbers: Iterable[int]) -> None:
        """Mark users as known to the newest fit."""
        self._change_users("fitted = 1", {}, ((number,) for number in numbers))


def _user(row: Sequence[Any]) -> UserRow:
    user = UserRow(*row)
    return user if user.features is None else user._replace(features=json.loads(row[3]))


def _decision(row: Sequence[Any]) -> DecisionRow:
    id_, person, policy, probability, control, version, time, context, available, *rest = row
    listed = None if available is None else tuple(json.loads(available))
    return DecisionRow(id_, person, policy, probability, bool(control), version, time, context, listed, *rest)


def _json(content: Any) -> str | None:
    return json.dumps(content) if content else None
