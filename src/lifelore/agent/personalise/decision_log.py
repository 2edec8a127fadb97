"""The log of a study's decisions as a stream: CSV or a JSON document a line, in order of time, a part at a time.

A part that was read ends at a decision, whose identifier is the cursor of the next part. Decisions have the order
of their times; with several programs that serve a study, read up to a minute ago to miss none.
"""

import json
from collections.abc import Iterator, Sequence
from typing import Any, Literal

from lifelore.agent.personalise.identifiers import identifiers, parse_identifier
from lifelore.agent.personalise.log.log_format import FORMULAS, escaped
from lifelore.agent.personalise.study import Study
from lifelore.core.errors import InputError
from lifelore.memory import Memory
from lifelore.memory.study_totals import first_id

COLUMNS = (
    "user", "policy", "outcome", "context", "time", "probability", "group", "decision", "version", "rule",
    "outcome_time", "available", "request",
)  # fmt: skip
"""Of the log of decisions, which `reuse fit` reads again."""
_READ = (
    "u.name", "d.policy", "d.outcome", "d.context", "d.time", "d.probability", "d.control", "d.id", "d.version",
    "d.ended", "d.available", "d.request",
)  # fmt: skip
ROWS = 10_000
"""Decisions of a part; more need more main memory."""
AT_ONCE = 500
"""Decisions that become text at once; more no longer fit the processor's cache, and take longer."""
GROUPS = ("personal", "control")
Format = Literal["csv", "ndjson"]
_QUOTED, _FORMULAS = '",\r\n', frozenset(FORMULAS)


def log_parts(
    memory: Memory,
    study: Study,
    form: Format = "csv",
    *,
    since: float | None = None,
    until: float | None = None,
    cursor: str | None = None,
    limit: int | None = None,
) -> Iterator[bytes]:
    """All decisions as text in UTF-8.

    Parameters
    ----------
    form : {"csv", "ndjson"}
        CSV as in RFC 4180, with ``COLUMNS`` and the features of the study, so that a new fit can read it: outcomes
        not yet known are empty, times are seconds since 1970, ``available`` is a JSON list of the policies that
        were available, empty where all were. A word that a spreadsheet would take for a formula begins with ``'``.
    since, until : float, optional
        Seconds since 1970: decisions from the first on, and before the second.
    cursor : str, optional
        A decision: only later ones.
    limit : int, optional
        Largest number of decisions.

    Raises
    ------
    InputError
        There is no such format, or the cursor is no decision.
    """
    if form not in ("csv", "ndjson"):
        raise InputError(f"format must be csv or ndjson, got '{form}'")
    after = b"" if since is None else first_id(int(1000 * since))
    if cursor is not None:
        after = max(after, parse_identifier(cursor))
    before = None if until is None else first_id(int(1000 * until))
    return _parts(memory, study, form, after, before, limit)


def _parts(
    memory: Memory, study: Study, form: Format, after: bytes, before: bytes | None, limit: int | None
) -> Iterator[bytes]:
    rules = {version: about["rule"] for version, about in memory.studies.settings(study.number).items()}
    names = () if study.feature_prior is None else study.feature_prior.names
    features = [name for name in names if name.strip().lower() not in COLUMNS]
    columns = (*_READ, "u.features") if features else _READ
    head = [*COLUMNS, *features]
    if form == "csv":
        yield _csv([[name] for name in head])
    left = limit
    while left is None or left > 0:
        size = ROWS if left is None else min(left, ROWS)
        with memory.studies.totals(study.number) as totals:
            rows = totals.log(columns, after, before, size)
        if rows:
            few = (_columns(rows[at : at + AT_ONCE], rules, features) for at in range(0, len(rows), AT_ONCE))
            yield b"".join(_csv(part) if form == "csv" else _documents(head, part) for part in few)
            after = rows[-1][_READ.index("d.id")]
        if len(rows) < size:
            return
        left = None if left is None else left - len(rows)


def _columns(rows: Sequence[Sequence[Any]], rules: dict[int, str], features: Sequence[str]) -> list[Sequence[Any]]:
    """The columns of some lines of the log, None where there is nothing."""
    user, policy, outcome, context, time, probability, control, id_, version, ended, available, request, *known = (
        zip(*rows, strict=True)
    )
    own = [json.loads(one or "{}") for one in known[0]] if features else []
    return [
        user, policy, outcome, context, [one / 1000 for one in time], probability,
        [GROUPS[one] for one in control], identifiers(id_), version, [rules.get(one) for one in version],
        [None if one is None else one / 1000 for one in ended], available, request,
        *([one.get(name) for one in own] for name in features),
    ]  # fmt: skip


def _csv(columns: Sequence[Sequence[Any]]) -> bytes:
    lines = map(",".join, zip(*map(_fields, columns), strict=True))
    return "\r\n".join([*lines, ""]).encode()


def _fields(column: Sequence[Any]) -> Sequence[str]:
    """The fields of a column of numbers or words, which are looked at one by one only where one is special."""
    words = [one for one in column if isinstance(one, str)]
    if not words:
        return ["" if one is None else repr(one) for one in column]
    text = "".join(words)
    if any(mark in text for mark in _QUOTED) or not _FORMULAS.isdisjoint({word[:1] for word in words}):
        return [_field(one) if one else "" for one in column]
    return column if len(words) == len(column) else [one or "" for one in column]


def _field(word: str) -> str:
    word = escaped(word)
    return '"' + word.replace('"', '""') + '"' if any(mark in word for mark in _QUOTED) else word


def _documents(names: Sequence[str], columns: Sequence[Sequence[Any]]) -> bytes:
    import msgspec  # of the extra web, as the service that asks for this format

    at = names.index("available")
    columns = [*columns[:at], [one and json.loads(one) for one in columns[at]], *columns[at + 1 :]]
    lines = zip(*columns, strict=True)
    return msgspec.json.Encoder().encode_lines([dict(zip(names, line, strict=True)) for line in lines])
