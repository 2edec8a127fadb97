"""Columns of a log's lines: words as codes and outcomes as numbers, checked many lines at a time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log_format import LEAVE_OUT, LOGGED, OPTIONAL, REFUSE, WEIGHT, LogFormat
from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_model import LARGEST

LONGEST = 200
FORMULAS = "=+-@\t\r"
"""First characters of what a spreadsheet takes for a formula."""
WORDS = ("user", "policy", *OPTIONAL, *LOGGED)
COUNTED = ("pending", "filled_outcomes", "filled_policies", "without_policy")
"""Reasons for which lines are left out or filled; see `ReuseLog`."""


@dataclass(frozen=True, eq=False)
class Lines:
    """The choices of a file whose outcome and policy are known.

    names : for each of `WORDS`, its different words in the order in which they came
    codes : for each of `WORDS`, (n,) int64, places in its names
    outcomes : (n,) float64
    line : (n,) int64, number of the line in the file
    numbers : for each of `LogFormat.numbers`, (n,) float64, NaN where missing
    counts : lines left out or filled, by the reason
    """

    names: tuple[tuple[str, ...], ...]
    codes: tuple[NDArray[np.int64], ...]
    outcomes: NDArray[np.float64]
    line: NDArray[np.int64]
    numbers: tuple[NDArray[np.float64], ...]
    counts: dict[str, int]


@dataclass
class ColumnReader:
    """Takes in chunks of a file's fields; `lines` gives all of them.

    Parameters
    ----------
    name : str
        Of the file, for messages.
    form : LogFormat
    """

    name: str
    form: LogFormat
    _codes: list[dict[str, int]] = field(default_factory=lambda: [{} for _ in WORDS])
    _parts: list[tuple[NDArray, ...]] = field(default_factory=list)
    _counts: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._counts = dict.fromkeys(COUNTED, 0)
        self._missing: set[str] = {"", *self.form.missing}
        # What a word of the file becomes; each different word is checked once.
        self._clean: list[dict[str, str]] = [{} for _ in WORDS]
        self._fill = _filling_outcome(self.form)

    def take(self, columns: Sequence[Sequence[str] | None], line: NDArray[np.int64]) -> None:
        """Take in lines.

        Parameters
        ----------
        columns : outcomes, `WORDS`, `LogFormat.numbers`; None for a column that the file does not have
        line : numbers of the lines in the file
        """
        outcomes, here = self._outcomes(columns[0] or [], line)
        last = len(WORDS) + 1
        words = [self._words(place, column, line) for place, column in enumerate(columns[1:last])]
        numbers = [
            self._numbers(name, column or [], line)
            for name, column in zip(self.form.numbers, columns[last:], strict=True)
        ]
        policies = words[1]
        absent = policies < 0
        if absent.any():
            words[1], here = self._without_policy(policies, absent, here)
        self._parts.append((outcomes[here], line[here], *(column[here] for column in (*words, *numbers))))

    def lines(self) -> Lines:
        """All lines taken in."""
        joined = [np.concatenate(part) for part in zip(*self._parts, strict=True)] or [
            np.array([], np.float64), *(np.array([], np.int64) for _ in range(len(WORDS) + 1)),
            *(np.array([], np.float64) for _ in self.form.numbers),
        ]  # fmt: skip
        names = tuple(tuple(codes) for codes in self._codes)
        words, numbers = tuple(joined[2 : 2 + len(WORDS)]), tuple(joined[2 + len(WORDS) :])
        return Lines(names, words, joined[0], joined[1], numbers, self._counts)

    def _outcomes(self, words: Sequence[str], line: NDArray[np.int64]) -> tuple[NDArray, NDArray]:
        """Outcomes, and which lines have one."""
        try:
            if self.form.decimal_comma:
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
            self._counts["filled_outcomes"] += missing
            return outcomes, np.ones(len(outcomes), bool)
        self._counts["pending"] += missing
        return outcomes, ~bad

    def _outcome(self, word: str, line: int) -> float:
        """The outcome of a line; NaN where it is missing."""
        word, where = word.strip(), f"{self.name} line {line}: "
        if word not in self._missing:
            return read_outcome(word, where, HINT, decimal_comma=self.form.decimal_comma)
        if self.form.missing_outcome == REFUSE:
            raise InputError(f"{where}outcome is missing; --missing-outcome says what that means")
        return math.nan

    def _numbers(self, name: str, words: Sequence[str], line: NDArray[np.int64]) -> NDArray[np.float64]:
        """A column of numbers; NaN where missing, which a weight may not be."""
        is_weight = WEIGHT in self.form.columns and name == self.form.numbers[0]
        values = np.empty(len(words))
        for place, word in enumerate(words):
            own, where = word.strip(), f"{self.name} line {line[place]}: "
            absent = own in self._missing
            values[place] = (
                math.nan if absent else read_outcome(own, where, decimal_comma=self.form.decimal_comma, name=name)
            )
            if is_weight and not values[place] >= 0:
                raise InputError(f"{where}{name} must be a weight of at least 0, got {own[:60]!r}")
        return values

    def _words(self, place: int, column: Sequence[str] | None, line: NDArray[np.int64]) -> NDArray[np.int64]:
        """Codes of the words; −1 for a missing policy."""
        codes = self._codes[place]
        if column is None:
            return np.full(len(line), codes.setdefault("", len(codes)))
        clean = self._clean[place]
        for word in set(column).difference(clean):
            clean[word] = self._checked(place, word, column, line)
        get = {word: -1 if self._is_absent(place, own) else codes.setdefault(own, len(codes))
               for word, own in ((word, clean[word]) for word in dict.fromkeys(column))}  # fmt: skip
        return np.fromiter(map(get.__getitem__, column), np.int64, len(column))

    def _is_absent(self, place: int, word: str) -> bool:
        return WORDS[place] == "policy" and not word

    def _checked(self, place: int, word: str, column: Sequence[str], line: NDArray[np.int64]) -> str:
        """The word without blanks around it, "" where it is missing and may be."""
        own = unescaped(word.strip())
        if own in self._missing and WORDS[place] != "user":
            if WORDS[place] == "policy" and self.form.missing_policy == REFUSE:
                where = f"{self.name} line {line[column.index(word)]}"
                raise InputError(
                    f"{where}: policy must be 1 to {LONGEST} printable characters, got {own!r}; --missing-policy "
                    "says what a missing policy means"
                )
            return ""
        if own in self._missing or not _is_word(own):
            check_word(
                f"{self.name} line {line[column.index(word)]}: {WORDS[place]}", "" if own in self._missing else own
            )
        return own

    def _without_policy(
        self, policies: NDArray[np.int64], absent: NDArray[np.bool_], here: NDArray[np.bool_]
    ) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Lines without a policy: left out, or given the policy that the format names."""
        if self.form.missing_policy == LEAVE_OUT:
            self._counts["without_policy"] += int(absent.sum())
            self._counts["pending"] -= int((absent & ~here).sum())
            return policies, here & ~absent
        self._counts["filled_policies"] += int(absent.sum())
        codes = self._codes[WORDS.index("policy")]
        policies[absent] = codes.setdefault(self.form.missing_policy, len(codes))
        return policies, here


HINT = "; leave it empty if it is not known, or say --missing WORD"


def _filling_outcome(form: LogFormat) -> float | None:
    if form.missing_outcome in (LEAVE_OUT, REFUSE):
        return None
    try:
        return read_outcome(form.missing_outcome)
    except InputError:
        raise InputError(
            f"missing_outcome must be {LEAVE_OUT}, {REFUSE} or a number, got '{form.missing_outcome}'"
        ) from None


def _is_word(word: str) -> bool:
    return 0 < len(word) <= LONGEST and word.isprintable()


def check_word(what: str, word: str) -> str:
    """`word` itself, if it is 1 to 200 printable characters."""
    if not _is_word(word):
        raise InputError(f"{what} must be 1 to {LONGEST} printable characters, got {word[:60]!r}")
    return word


def escaped(word: str | None) -> str | None:
    """The word behind ``'`` where a spreadsheet would take it for a formula."""
    return "'" + word if word and word[0] in FORMULAS else word


def unescaped(word: str) -> str:
    """The word of `escaped`."""
    return word[1:] if word[:1] == "'" and len(word) > 1 and word[1] in FORMULAS else word


def read_outcome(
    text: str, where: str = "", hint: str = "", *, decimal_comma: bool = False, name: str = "outcome"
) -> float:
    """A finite number of at most `LARGEST` in size; InputError, which names the column, for anything else."""
    if decimal_comma and "." in text:
        raise InputError(f"{where}{name} must have a comma before its decimals, got {text[:60]!r}")
    try:
        outcome = float(text.replace(",", ".") if decimal_comma else text)
    except ValueError:
        outcome = math.nan
    if not math.isfinite(outcome):
        hint = "; write decimals with a point, or say --decimal-comma" if "," in text else hint
        raise InputError(f"{where}{name} must be a finite number, got {text[:60]!r}{hint}")
    if abs(outcome) > LARGEST:
        raise InputError(f"{where}{name} must be at most {LARGEST:g} in size, got {text[:60]!r}")
    return outcome
