"""The past of users: outcomes in logs of other systems, each line once, before memory's own decisions.

A line is known by the identifier that it gives, else by its user, policy and time; in a log without times by user,
policy and outcome, and equal lines by their number. So a log counts once in any order and in any window. A fit
takes its logs' lines in place of those of the fit before; `warm` adds lines.
"""

import hashlib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import starmap
from typing import Any, NamedTuple

import numpy as np

from lifelore.agent.personalise.identifiers import parse_identifier
from lifelore.agent.personalise.log.log import ReuseLog, read_log
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.study import Study, known_users, user_key
from lifelore.core.errors import InputError
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name
from lifelore.memory.study_rows import PastRow, StudyRows, UserRow


class Line(NamedTuple):
    """An outcome that a user had elsewhere.

    time : milliseconds since 1970; 0: not known, the line then comes after the lines before it
    given : its identifier, "" where it has none
    """

    user: str
    policy: str
    outcome: float
    time: int = 0
    given: str = ""
    context: str | None = None
    features: dict[str, float] | None = None
    type: str | None = None


def warm(sources: Any, memory: Memory, study: Study, form: LogFormat | None = None) -> dict[str, Any]:
    """Add the lines of logs to the past of their users; the library stays as it is.

    Parameters
    ----------
    sources : sequence of paths or tables, or a table
        As `read_log` takes them.

    Returns
    -------
    dict
        ``study``; ``rows`` added, of ``users``; ``known``: rows that are in the past already; ``decisions``:
        rows left out because memory has them as decisions; ``unknown_policies``: rows whose policy the
        library does not know, which give no evidence; ``unknown_types``: types of users that it does not know;
        ``repeated``: rows that an earlier log of the call has, too, and that are left out;
        ``by_time``: whether every line has a time or an identifier; ``unread_times``: rows whose time is no date
        or number, and only tells lines apart; ``pending``, ``filled_outcomes``, ``filled_policies``,
        ``without_policy`` (see `ReuseLog`).

    Raises
    ------
    InputError, NotFoundError
        A log breaks a rule; memory is as it was.
    """
    log = each_line_once(read_log(sources, form))
    return add_lines(memory, study, lines_of(log)) | {"unread_times": len(unread_times(log))} | log.counts


def add_lines(memory: Memory, study: Study, lines: Sequence[Line]) -> dict[str, Any]:
    """Add lines to the past of their users; the document of `warm` without what tells of a log.

    Raises
    ------
    InputError
        A name is no printable text.
    """
    for name in ("user", "policy", "context"):
        for word in {getattr(line, name) for line in lines} - {None}:
            check_name(name, word)
    with memory.studies.writing(study.number) as rows:
        counts = _stored(rows, study, lines, fitted=False)
    policies, types = study.library.policies, study.library.types
    return {
        "study": study.name,
        **counts,
        "unknown_policies": sum(line.policy not in policies for line in lines),
        "unknown_types": sorted({line.type for line in lines if line.type} - set(types)),
        "by_time": all(line.time or line.given for line in lines),
    }


def keep_fitted_past(memory: Memory, study: Study, log: ReuseLog) -> dict[str, int]:
    """Make the past that of the fit's logs, and of those lines of `warm` that are not among them."""
    with memory.studies.writing(study.number) as rows:
        rows.begin_fit()
        return _stored(rows, study, lines_of(log), fitted=True)


def _stored(rows: StudyRows, study: Study, lines: Sequence[Line], *, fitted: bool) -> dict[str, int]:
    """Store lines; numbers of new ``rows``, of their ``users``, of ``known`` rows, of memory's ``decisions``."""
    names = list({line.user: None for line in lines})
    users = known_users(rows, study, names, lock=True)
    if new := [name for name in names if name not in users]:
        users |= rows.add_users([(name, None, None) for name in new], 0)
    rows.describe(_described(lines, users))
    if fitted:
        rows.mark_fitted(user.number for user in users.values())
    ids = identities(study.name, lines)
    own, there = rows.decisions(ids).keys(), rows.known_past(ids)
    new = {
        id_: PastRow(id_, users[line.user].number, line.policy, line.outcome, line.time or place, fitted)
        for place, (id_, line) in enumerate(zip(ids, lines, strict=True))
        if id_ not in own and id_ not in there
    }
    rows.add_past(new.values())
    changed = {row.person for row in new.values()}
    if not fitted:  # `begin_fit` has made all beliefs out of date
        rows.keep_beliefs(((number, None) for number in changed), 0)
    decisions = sum(id_ in own for id_ in ids)
    known = len(lines) - len(new) - decisions
    return {"rows": len(new), "users": len(changed), "known": known, "decisions": decisions}


def _described(lines: Sequence[Line], users: Mapping[str, UserRow]) -> Iterator[tuple[int, Any, Any, Any]]:
    """The users of whom lines tell another context, features or type; the last line that names one counts."""
    contexts = {line.user: line.context for line in lines if line.context}
    features = {line.user: line.features for line in lines if line.features}
    types = {line.user: line.type for line in lines if line.type}
    for name, user in users.items():
        now = contexts.get(name, user.context), features.get(name, user.features), types.get(name, user.type)
        if now != (user.context, user.features, user.type):
            yield user.number, *now


def identities(study: str, lines: Sequence[Line]) -> list[bytes]:
    """The identity of each line, 16 bytes, in the order of the lines' times."""
    seen: dict[str, int] = {}
    keys = {user: user_key(study, user) for user in {line.user for line in lines}}
    found = []
    for line in lines:
        if line.given:
            found.append(_given(line.given))
            continue
        text = f"{keys[line.user]}\x1f{line.policy}\x1f{line.time or repr(line.outcome)}"
        seen[text] = number = seen.get(text, 0) + 1
        drawn = hashlib.sha256(f"{text}\x1f{number}".encode()).digest()
        marked = bytes((0x80 | drawn[0] & 0x0F, drawn[1], 0x80 | drawn[2] & 0x3F))  # as of a UUID of version 8
        found.append(max(0, line.time).to_bytes(6, "big") + marked + drawn[3:10])
    return found


def _given(identifier: str) -> bytes:
    """A UUID as it is, any other identifier by its hash."""
    try:
        return parse_identifier(identifier)
    except InputError:
        return hashlib.sha256(identifier.encode()).digest()[:16]


def each_line_once(log: ReuseLog) -> ReuseLog:
    """The log without rows that an earlier file has, too; their number is ``repeated`` in its counts.

    The n-th of equal lines in one file is the n-th in another. Rows with neither a time nor an identifier stay.
    """
    new = np.ones(len(log), bool)
    if not log.file.any():
        return log.keeping(new, "repeated")
    at = [time or word for time, word in zip(log.times, log.time.names, strict=True)]
    number, known = Counter[tuple[Any, ...]](), set[tuple[Any, ...]]()
    columns = (log.file, log.user.codes, log.policy.codes, log.time.codes, log.decision.codes)
    rows = zip(*(column.tolist() for column in columns), strict=True)
    for row, (file, user, policy, time, decision) in enumerate(rows):
        given = log.decision.names[decision]
        if given or at[time]:
            which = (given,) if given else (user, policy, at[time])
            number[file, which] += 1
            line = which, number[file, which]
            new[row] = line not in known
            known.add(line)
    return log.keeping(new, "repeated")


def lines_of(log: ReuseLog) -> list[Line]:
    """The rows of a log as lines."""
    users, policies, given, n = log.user.words, log.policy.words, log.decision.words, len(log)
    times = [log.times[code] for code in log.time.codes.tolist()]
    seen = Counter[tuple[str, str, str]]()
    for row in [row for row in range(n) if times[row] is None]:
        times[row] = 0
        if not given[row]:
            # A word that is no time tells lines apart all the same; equal lines by their number.
            which = users[row], policies[row], log.time.names[log.time.codes[row]]
            seen[which] += 1
            given[row] = "\x1f".join((*which, str(seen[which])))
    features: list[dict[str, float] | None] = [None] * n
    if log.feature_names:
        for row in np.flatnonzero(np.isfinite(log.features).all(axis=1)).tolist():
            features[row] = dict(zip(log.feature_names, log.features[row].tolist(), strict=True))
    contexts, types = ([word or None for word in column.words] for column in (log.context, log.type))
    columns = (users, policies, log.outcomes.tolist(), times, given, contexts, features, types)
    return list(starmap(Line, zip(*columns, strict=True)))


def unread_times(log: ReuseLog) -> list[str]:
    """The time of each row where it is a word that is no time."""
    unread = np.array([time is None for time in log.times])[log.time.codes]
    return [log.time.names[code] for code in log.time.codes[unread].tolist()]
