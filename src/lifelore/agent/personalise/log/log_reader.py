"""Reads the CSV of logs: fields are cut, words become codes and outcomes numbers, many lines at a time."""

import codecs
import csv
import io
import math
from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log_format import (
    GROUP,
    LEAVE_OUT,
    OPTIONAL,
    REFUSE,
    SEPARATORS,
    WEIGHT,
    LogFormat,
    read_outcome,
    unescaped,
)
from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_rows import LARGEST
from lifelore.memory.record_rules import LONGEST_NAME, check_name, is_name

CHUNK = 1 << 16
"""Lines taken in at a time; more need more memory, fewer more time."""
WORDS = ("user", "policy", *OPTIONAL, GROUP)
COUNTED = ("pending", "filled_outcomes", "filled_policies", "without_policy")
"""Reasons for which lines are left out or filled; see `ReuseLog`."""
HINT = "; yes and no count as 1 and 0; leave it empty if it is not known, or say --missing WORD"

Ints = NDArray[np.int64]


class LogReader:
    """Reads files one after the other; words of all files have one numbering.

    Attributes
    ----------
    codes : dict of str to dict of str to int
        Number of each word that came, for each of `WORDS`.
    counts : dict of str to int
        Lines left out or filled, by the reason.
    """

    def __init__(self) -> None:
        self.codes: dict[str, dict[str, int]] = {name: {} for name in WORDS}
        self.counts: dict[str, int] = dict.fromkeys(COUNTED, 0)
        # The code of each word as the file has it, so that it is checked once; -1: a missing policy.
        self._known: dict[str, dict[str, int]] = {name: {} for name in WORDS}
        self._parts: list[tuple[NDArray, ...]] = []
        self._n_files = 0

    def read(self, content: bytes, name: str, form: LogFormat) -> None:
        """Read a file, which has this name in messages; see `read_log` for its errors."""
        self._name, self._form, self._fill = name, form, _filling_outcome(form)
        self._missing = {"", *form.missing}
        # Some programs begin their UTF-8 with a mark.
        utf8 = form.encoding.lower().replace("-", "").replace("_", "") == "utf8"
        text = io.TextIOWrapper(io.BytesIO(content), "utf-8-sig" if utf8 else form.encoding, newline="")
        try:
            self._read(iter(text))
        except UnicodeError:
            known = "UTF-8" if utf8 else form.encoding
            marked = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
            other = "utf-16" if marked else "latin-1, or another"
            raise InputError(
                f"{name} must be CSV in {known}, got bytes that are not; say --encoding {other}"
            ) from None
        self._n_files += 1

    def columns(self) -> tuple[NDArray, Ints, Ints, list[Ints], list[NDArray]]:
        """Of all lines: outcomes, files, lines in their files, codes of each of `WORDS`, and numbers."""
        if not self._parts:
            none = np.zeros(0, np.int64)
            return np.zeros(0), none, none, [none] * len(WORDS), [np.zeros(0)] * len(self._form.numbers)
        outcomes, file, line, *rest = (np.concatenate(part) for part in zip(*self._parts, strict=True))
        return outcomes, file, line, rest[: len(WORDS)], rest[len(WORDS) :]

    def _read(self, lines: Iterator[str]) -> None:
        first = next(lines, "")
        above = int(first.lower().startswith("sep="))  # Excel's line about the separator, which the header shows
        if above:
            first = next(lines, "")
        reader = csv.reader(chain([first], lines), strict=True, delimiter=_separator(first, self._form))
        try:
            header = [unescaped(column.strip()).lower() for column in next(reader, [])]
            _check_header(header, self._name, self._form)
            rows: list[list[str]] = []
            at: list[int] = []
            for fields in reader:
                # Blank lines are none.
                if fields and (fields[0].strip() or any(map(str.strip, fields))):
                    rows.append(fields)
                    at.append(reader.line_num + above)
                    if len(rows) == CHUNK:
                        self._take(header, rows, at)
                        rows, at = [], []
            if rows:
                self._take(header, rows, at)
        except csv.Error as error:
            raise InputError(f"{self._name} line {reader.line_num + above}: not CSV ({error})") from None

    def _take(self, header: list[str], rows: list[list[str]], at: list[int]) -> None:
        if set(map(len, rows)) != {len(header)}:
            fields, place = next(pair for pair in zip(rows, at, strict=True) if len(pair[0]) != len(header))
            raise InputError(
                f"{self._name} line {place}: must have {len(header)} fields like the header, got {len(fields)}"
            )
        columns, form, line = dict(zip(header, zip(*rows, strict=True), strict=True)), self._form, np.array(at)
        outcomes, here = self._outcomes(columns[form.column("outcome")], line)
        words = [self._words(name, columns.get(form.column(name)) if name in form.read else None, line)
                 for name in WORDS]  # fmt: skip
        numbers = [self._numbers(name, columns[name], line) for name in form.numbers]
        absent = words[1] < 0
        if absent.any():
            here = self._without_policy(words[1], absent, here)
        file = np.full(len(at), self._n_files)
        self._parts.append(tuple(column[here] for column in (outcomes, file, line, *words, *numbers)))

    def _outcomes(self, words: Sequence[str], line: Ints) -> tuple[NDArray, NDArray]:
        """Outcomes, and which lines have one."""
        try:
            if self._form.decimal_comma:
                raise ValueError("each word is read by itself")
            outcomes = np.array(list(map(float, words)), np.float64)
        except ValueError:
            outcomes = np.array([self._outcome(word, number) for word, number in zip(words, line, strict=True)])
        bad = ~(np.abs(outcomes) <= LARGEST)
        for place in np.flatnonzero(bad).tolist():
            self._outcome(words[place], line[place])
        missing = int(bad.sum())
        if self._fill is not None:
            outcomes[bad] = self._fill
            self.counts["filled_outcomes"] += missing
            return outcomes, np.ones(len(outcomes), bool)
        self.counts["pending"] += missing
        return outcomes, ~bad

    def _outcome(self, word: str, line: int) -> float:
        """The outcome of a line; NaN where it is missing."""
        word, where = word.strip(), f"{self._name} line {line}: "
        if word not in self._missing:
            return read_outcome(word, where, HINT, decimal_comma=self._form.decimal_comma)
        if self._form.missing_outcome == REFUSE:
            raise InputError(f"{where}outcome is missing; --missing-outcome says what that means")
        return math.nan

    def _numbers(self, name: str, words: Sequence[str], line: Ints) -> NDArray[np.float64]:
        """A column of numbers; NaN where missing, which a weight may not be."""
        is_weight = WEIGHT in self._form.columns and name == self._form.numbers[0]
        values = np.full(len(words), math.nan)
        for place, word in enumerate(map(str.strip, words)):
            where = f"{self._name} line {line[place]}: "
            if word not in self._missing:
                values[place] = read_outcome(word, where, decimal_comma=self._form.decimal_comma, name=name)
            if is_weight and not values[place] >= 0:
                raise InputError(f"{where}{name} must be a weight of at least 0, got {word[:60]!r}")
        return values

    def _words(self, name: str, column: Sequence[str] | None, line: Ints) -> Ints:
        """Codes of the words; −1 for a missing policy."""
        codes, known = self.codes[name], self._known[name]
        if column is None:
            return np.full(len(line), codes.setdefault("", len(codes)))
        for word in [word for word in dict.fromkeys(column) if word not in known]:
            own = unescaped(word.strip())
            own = "" if own in self._missing else own
            if not own and name == "policy" and self._form.missing_policy != REFUSE:
                known[word] = -1
                continue
            if (own or name in ("user", "policy")) and not is_name(own):
                self._refuse(name, own, line[column.index(word)])
            known[word] = codes.setdefault(own, len(codes))
        return np.fromiter(map(known.__getitem__, column), np.int64, len(column))

    def _refuse(self, name: str, word: str, line: int) -> None:
        where = f"{self._name} line {line}: "
        if not word:
            hint = "leave the line out, or give it a user"
            if name == "policy":
                hint = "--missing-policy says what a missing policy means"
            raise InputError(f"{where}{name} must be 1 to {LONGEST_NAME} printable characters, got ''; {hint}")
        check_name(where + name, word)

    def _without_policy(self, policies: Ints, absent: NDArray, here: NDArray) -> NDArray:
        """Leave lines without a policy out, or give them that which the format names; which lines stay."""
        if self._form.missing_policy == LEAVE_OUT:
            self.counts["without_policy"] += int(absent.sum())
            self.counts["pending"] -= int((absent & ~here).sum())
            return here & ~absent
        self.counts["filled_policies"] += int(absent.sum())
        codes = self.codes["policy"]
        policies[absent] = codes.setdefault(self._form.missing_policy, len(codes))
        return here


def _filling_outcome(form: LogFormat) -> float | None:
    if form.missing_outcome in (LEAVE_OUT, REFUSE):
        return None
    try:
        return read_outcome(form.missing_outcome)
    except InputError:
        raise InputError(
            f"missing_outcome must be {LEAVE_OUT}, {REFUSE} or a number, got '{form.missing_outcome}'"
        ) from None


def _separator(header: str, form: LogFormat) -> str:
    """The separator that makes the needed columns, a comma where none does."""
    if form.separator is not None:
        return SEPARATORS[form.separator]
    needed = {form.column(column) for column in form.needed}
    for separator in SEPARATORS.values():
        if {word.strip().strip('"').strip().lower() for word in header.split(separator)}.issuperset(needed):
            return separator
    return SEPARATORS["comma"]


def _check_header(header: Sequence[str], name: str, form: LogFormat) -> None:
    needed = ", ".join(form.column(column) for column in form.needed)
    if not any(header):
        raise InputError(f"{name} must begin with a header that names {needed}, it is empty")
    for own in (*map(form.column, form.read), *form.numbers):
        if header.count(own) > 1:
            raise InputError(f"{name} must have one column '{own}', its header names {header.count(own)}")
    every = (*map(form.column, (*form.needed, *form.columns)), *form.numbers)
    missing = [column for column in every if column not in header]
    if missing:
        raise InputError(
            f"{name} must have the columns {needed}, separated by commas; it has no "
            f"{' and no '.join(dict.fromkeys(missing))}, its header is '{','.join(header)[:80]}'; name others "
            "with --columns user=NAME,policy=NAME,outcome=NAME"
        )
