"""Logs of choices and their outcomes: CSV with a header and one choice a line.

    user      who it was for; any text
    policy    what was chosen: a configuration, a variant, a behaviour
    outcome   how well it went, a number, larger is better; empty: not yet known, the line is left out and counted
    type      optional: what kind of user it is, if known; may be empty on some lines, the same on all others
    context   optional: what is known of a user before the first choice (device, country, shop)
    decision  optional: the identifier of the line, such as what `reuse choose` printed
    time      optional: when it was, as seconds since 1970 or an ISO date

Commas, semicolons or tabs lie between columns, as the header has them; capitals in column names do not matter.
Other columns are ignored. Several logs are read as one. `LogFormat` reads logs that are written otherwise.
"""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log_format import WEIGHT, LogFormat, parse_time
from lifelore.agent.personalise.log.log_reader import WORDS, LogReader
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.interaction.outcomes.frame_columns import FrameColumns, is_frame

MANY_POLICIES = 20
"""Number of policies up to which a log may have few lines of each; beyond, it looks like the wrong column."""


@dataclass(frozen=True, eq=False)
class Column:
    """A column of words: each different word once, and its place for each row.

    names : sorted
    codes : (n,) int64, places in `names`
    """

    names: tuple[str, ...]
    codes: NDArray[np.int64]

    @property
    def words(self) -> list[str]:
        """The word of each row."""
        return [self.names[code] for code in self.codes.tolist()]

    def take(self, rows: NDArray[np.int64]) -> "Column":
        """The column of the rows at some places, and the names that they have."""
        return _column(self.names, self.codes[rows])


@dataclass(frozen=True, eq=False)
class ReuseLog:
    """Choices whose outcome is known, one a row.

    Parameters
    ----------
    user, policy, type, context, decision, time : Column
        The last four are "" where the log says nothing.
    outcomes : (n,) float64
        Finite.
    file, line : (n,) int64
        Number of each row's source, and of its line there.
    counts : dict of str to int
        Lines left out because their outcome (``pending``) or policy (``without_policy``) is missing; lines whose
        missing outcome or policy got what the format says (``filled_outcomes``, ``filled_policies``).
    group : Column
        "" where the log says nothing, and where the format does not read it.
    probability, weights : (n,) float64, optional
        NaN where missing, and at least 0; None where the format does not read them.
    feature_names : tuple of str
        As the format gives them.
    features : (n, n_features) float64
        NaN where missing.
    """

    user: Column
    policy: Column
    type: Column
    context: Column
    decision: Column
    time: Column
    outcomes: NDArray[np.float64]
    file: NDArray[np.int64]
    line: NDArray[np.int64]
    counts: dict[str, int]
    group: Column
    probability: NDArray[np.float64] | None = None
    weights: NDArray[np.float64] | None = None
    feature_names: tuple[str, ...] = ()
    features: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)))

    def __len__(self) -> int:
        return len(self.outcomes)

    @property
    def says_types(self) -> bool:
        """Whether any row names a type."""
        return any(self.type.names)

    def take(self, rows: NDArray[np.int64]) -> "ReuseLog":
        """The log with the rows at some places alone, and the names that they have."""
        columns = {name: getattr(self, name).take(rows) for name in WORDS}
        names = ("outcomes", "file", "line", "features", "probability", "weights")
        own = {name: values[rows] for name in names if (values := getattr(self, name)) is not None}
        return replace(self, **columns, **own)

    def keeping(self, rows: NDArray[np.bool_], others: str) -> "ReuseLog":
        """The log with some rows alone; the number of the others is in `counts` under the name `others`."""
        counts = self.counts | {others: int((~rows).sum())}
        return replace(self if rows.all() else self.take(np.flatnonzero(rows)), counts=counts)

    @cached_property
    def times(self) -> list[int | None]:
        """The `parse_time` of each name of the column of times."""
        return [parse_time(word) for word in self.time.names]

    @cached_property
    def type_of_user(self) -> NDArray[np.int64]:
        """Place of each user's type in `type.names`, −1 where no row names it, (n_users,)."""
        return self._last_of_user(self.type)

    @cached_property
    def context_of_user(self) -> NDArray[np.int64]:
        """Place of each user's last context in `context.names`, −1 where no row names it, (n_users,)."""
        return self._last_of_user(self.context)

    @cached_property
    def features_of_user(self) -> NDArray[np.float64]:
        """Each user's last value of each feature, NaN where no row has it, (n_users, n_features)."""
        found = np.full((len(self.user.names), len(self.feature_names)), np.nan)
        for place, column in enumerate(self.features.T):
            known = ~np.isnan(column)
            found[self.user.codes[known], place] = column[known]
        return found

    def _last_of_user(self, column: Column) -> NDArray[np.int64]:
        found = np.full(len(self.user.names), -1)
        said = np.array([bool(name) for name in column.names])[column.codes]
        found[self.user.codes[said]] = column.codes[said]
        return found


def read_log(sources: Any, form: LogFormat | None = None) -> ReuseLog:
    """Read logs as one.

    Parameters
    ----------
    sources : sequence of paths or tables, or a table
        Files of CSV, or tables in memory: of pandas, polars or Arrow, or mappings of columns.

    Raises
    ------
    NotFoundError
        There is no such file.
    InputError
        A column is missing, a line breaks its rule (the message says which), a user has two types, the policies
        are nearly as many as the lines, no outcome is known, or a log is given twice.
    StoreError
        The disk refuses.
    """
    form = form or LogFormat()
    sources = [sources] if is_frame(sources) else list(sources)
    paths = [NAME if is_frame(source) else str(source) for source in sources]
    places = [number if is_frame(source) else Path(source).resolve() for number, source in enumerate(sources)]
    contents = [frame_content(source, form) if is_frame(source) else _content(Path(source)) for source in sources]
    for number, other in combinations(range(len(sources)), 2):
        if places[number] == places[other] or contents[number] == contents[other]:
            given = "is given twice" if paths[number] == paths[other] else f"and '{paths[other]}' are equal"
            raise InputError(f"log '{paths[number]}' {given}; its lines would count twice, leave one out")
    reader = LogReader()
    for source, path, content in zip(sources, paths, contents, strict=True):
        reader.read(content, path, frame_format(form) if is_frame(source) else form)
    log = _log(reader, form)
    if not len(log):
        raise InputError(f"{', '.join(paths)} must hold at least one line with an outcome, got none")
    _check_types(log, paths)
    _check_policies(log, paths)
    return log


def _content(path: Path) -> bytes:
    if not path.is_file():
        what = "is no file" if path.exists() else "does not exist"
        raise NotFoundError(f"log '{path}' {what}; give a CSV file")
    try:
        return path.read_bytes()
    except OSError as error:
        raise StoreError(f"cannot read {path}: {error.strerror}") from None


def _log(reader: LogReader, form: LogFormat) -> ReuseLog:
    outcomes, file, line, words, numbers = reader.columns()
    columns = {name: _column(list(reader.codes[name]), rows) for name, rows in zip(WORDS, words, strict=True)}
    weights = numbers.pop(0) if WEIGHT in form.columns else None
    probability = numbers.pop(0) if form.probabilities else None
    return ReuseLog(
        **columns, outcomes=outcomes, file=file, line=line, counts=reader.counts, weights=weights,
        probability=probability,
        feature_names=tuple(name.strip() for name in form.features),
        features=np.stack(numbers, axis=1) if numbers else np.empty((len(outcomes), 0)),
    )  # fmt: skip


def _column(words: Sequence[str], rows: NDArray[np.int64]) -> Column:
    """The column of rows that have places in `words`; its names are the words that a row has, sorted."""
    used = np.flatnonzero(np.bincount(rows, minlength=len(words))).tolist()
    used.sort(key=words.__getitem__)
    number: NDArray[np.int64] = np.zeros(len(words), np.int64)
    number[used] = np.arange(len(used))
    return Column(tuple(words[place] for place in used), number[rows])


def _check_types(log: ReuseLog, paths: Sequence[str]) -> None:
    """Refuse a user with two types, and name the lines."""
    said = np.flatnonzero(np.array([bool(name) for name in log.type.names])[log.type.codes])
    _, at = np.unique(np.stack([log.user.codes, log.type.codes])[:, said], axis=1, return_index=True)
    first: dict[int, int] = {}
    for row in np.sort(said[at]).tolist():
        earlier = first.setdefault(int(log.user.codes[row]), row)
        if earlier != row:
            user, type_, before = log.user.words[row], log.type.words[row], log.type.words[earlier]
            where = [f"{paths[log.file[one]]} line {log.line[one]}" for one in (row, earlier)]
            raise InputError(
                f"{where[0]}: a user must have one type, got '{type_}' for '{user}', who is '{before}' in "
                f"{where[1]}; leave the type empty, or make two users of them"
            )


def _check_policies(log: ReuseLog, paths: Sequence[str]) -> None:
    n_policies, n_lines = len(np.unique(log.policy.codes)), len(log)
    if n_policies > MANY_POLICIES and 2 * n_policies > n_lines:
        raise InputError(
            f"{', '.join(paths)}: policy must name a configuration that recurs; {n_policies:,} policies "
            f"in {n_lines:,} lines looks like the wrong column, give the right one with --columns policy=NAME"
        )


NAME = "frame (its first row is line 2)"
"""Name of a table in messages, which count lines as in a file."""


def frame_content(frame: Any, form: LogFormat) -> bytes:
    """The columns of a table that a log has, as CSV in UTF-8; equal tables give equal bytes.

    Raises
    ------
    InputError
        `frame` is no table, or its columns have different lengths.
    NotFoundError
        `frame` is an Arrow stream, and no library that reads it is installed.
    """
    columns = FrameColumns(frame)
    known = {form.column(name) for name in (*form.read, *form.columns)} | set(form.numbers)
    names = [name for name in columns.names if name.strip().lower() in known]
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    words = [list(map(_word, columns.column(name))) for name in names]
    if len(set(map(len, words))) > 1:
        lengths = ", ".join(f"{name} {len(own)}" for name, own in zip(names, words, strict=True))
        raise InputError(f"frame must have columns of one length, got {lengths}")
    writer.writerows(zip(*words, strict=True))
    return text.getvalue().encode()


def frame_format(form: LogFormat) -> LogFormat:
    """The format of `frame_content`."""
    return replace(form, separator="comma", decimal_comma=False, encoding="utf-8")


def _word(value: Any) -> str:
    """The word as a file has it: tables turn whole numbers into floats where a value of the column is missing."""
    if value is None:
        return ""
    whole = isinstance(value, bool) or (isinstance(value, float) and value.is_integer())
    return str(int(value)) if whole else str(value)
