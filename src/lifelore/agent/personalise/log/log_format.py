"""How the CSV of a log is written: columns, separator, decimals, encoding, missing values, words and numbers."""

import codecs
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.outcomes.outcome_rows import LARGEST

NEEDED = ("user", "policy", "outcome")
OPTIONAL = ("type", "context", "decision", "time")
PROBABILITY, GROUP = "probability", "group"
"""Columns of the log that `reuse report` writes, read for off-policy evaluation only."""
WEIGHT = "weight"
"""Column of weights; read only where `columns` names it, because a log may have a column of that name."""
SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t"}
LEAVE_OUT, REFUSE = "leave-out", "refuse"
TRUTHS = {"yes": 1.0, "true": 1.0, "no": 0.0, "false": 0.0}
"""Words for outcomes of two values, in small letters."""
LARGEST_SECONDS = 1e11
"""Numbers above are milliseconds: as seconds they would lie after the year 5000."""
FORMULAS = "=+-@\t\r"
"""First characters of what a spreadsheet takes for a formula."""


@dataclass(frozen=True)
class LogFormat:
    """Columns, separators and missing values of a log.

    Parameters
    ----------
    columns : dict of str to str
        The log's own name of a column, by ours (`NEEDED`, `OPTIONAL`, `PROBABILITY`, `GROUP`, `WEIGHT`); others
        have our names. Capitals do not matter.
    separator : {"comma", "semicolon", "tab"}, optional
        Between columns; default: the one that makes the needed columns of the header.
    decimal_comma : bool
        Whether outcomes have a comma before their decimals; a point is then an error.
    encoding : str
        Of the text, such as ``latin-1``.
    missing : tuple of str
        Words that mean that a value is missing, beside the empty field.
    missing_outcome : str
        ``leave-out`` the line, for it is not known yet; ``refuse`` the log; or the number that a missing outcome
        means, such as ``0``.
    missing_policy : str
        ``refuse`` the log; ``leave-out`` the line; or the name of the policy that a missing policy means.
    features : tuple of str
        Names of columns of numbers that are known of a user beforehand.
    probabilities : bool
        Whether to read the column ``probability``, which the log must then have, and ``group``.

    Examples
    --------
    >>> LogFormat({"user": "household", "outcome": "bought"}, separator="semicolon").missing_policy
    'refuse'
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    separator: str | None = None
    decimal_comma: bool = False
    encoding: str = "utf-8"
    missing: tuple[str, ...] = ()
    missing_outcome: str = LEAVE_OUT
    missing_policy: str = REFUSE
    features: tuple[str, ...] = ()
    probabilities: bool = False

    def __post_init__(self) -> None:
        known = (*NEEDED, *OPTIONAL, PROBABILITY, GROUP, WEIGHT)
        for ours in self.columns:
            if ours not in known:
                raise InputError(f"columns must name {', '.join(known)}, got '{ours}'")
        if len(set(self.features)) < len(self.features) or not all(map(str.strip, self.features)):
            raise InputError(f"features must be names of columns, each once, got {', '.join(self.features)!r}")
        if self.separator is not None and self.separator not in SEPARATORS:
            raise NotFoundError(f"separator must be one of {', '.join(SEPARATORS)}, got '{self.separator}'")
        try:
            codecs.lookup(self.encoding)
        except LookupError:
            raise NotFoundError(f"encoding must be one that Python knows, got '{self.encoding}'") from None

    @property
    def needed(self) -> tuple[str, ...]:
        """Columns that the log must have, by our names."""
        return (*NEEDED, PROBABILITY) if self.probabilities else NEEDED

    @property
    def read(self) -> tuple[str, ...]:
        """Columns of words and outcomes that are read where the log has them, by our names."""
        return (*NEEDED, *OPTIONAL, GROUP) if self.probabilities else (*NEEDED, *OPTIONAL)

    def column(self, ours: str) -> str:
        """The log's name of a column, in small letters."""
        return self.columns.get(ours, ours).strip().lower()

    @property
    def numbers(self) -> tuple[str, ...]:
        """The log's names of its columns of numbers beside the outcome: weights, probabilities, features."""
        ours = [WEIGHT] * (WEIGHT in self.columns) + [PROBABILITY] * self.probabilities
        return (*map(self.column, ours), *(name.strip().lower() for name in self.features))


def parse_features(words: Sequence[str]) -> dict[str, float]:
    """Numbers from words such as ``age=31,visits=4``.

    Raises
    ------
    InputError
        A part is not ``NAME=NUMBER``, or a name comes twice.
    """
    features: dict[str, float] = {}
    for name, text in parse_columns(words, "features must be NAME=NUMBER, each once, such as age=31").items():
        try:
            features[name] = float(text)
        except ValueError:
            raise InputError(f"feature '{name}' must be a number, got '{text}'") from None
    return features


def parse_columns(
    words: Sequence[str], rule: str = "columns must be OURS=THEIRS, each once, such as user=household"
) -> dict[str, str]:
    """Names of columns from words such as ``user=household,policy=brand``; `rule` begins the error.

    Raises
    ------
    InputError
        A part is not ``OURS=THEIRS``, or a column is named twice.
    """
    columns: dict[str, str] = {}
    for part in (part for word in words for part in word.split(",")):
        ours, found, theirs = (piece.strip() for piece in part.partition("="))
        if not (ours and found and theirs) or ours in columns:
            raise InputError(f"{rule}, got {part!r}")
        columns[ours] = theirs
    return columns


def escaped(word: str) -> str:
    """The word behind ``'`` where a spreadsheet would take it for a formula."""
    return "'" + word if word[:1] and word[0] in FORMULAS else word


def unescaped(word: str) -> str:
    """The word of `escaped`."""
    return word[1:] if word[:1] == "'" and len(word) > 1 and word[1] in FORMULAS else word


def read_outcome(
    text: str, where: str = "", hint: str = "", *, decimal_comma: bool = False, name: str = "outcome"
) -> float:
    """A finite number of at most `LARGEST` in size, or of `TRUTHS`; else InputError, which names the column."""
    if decimal_comma and "." in text:
        raise InputError(
            f"{where}{name} must have a comma before its decimals, and no point between thousands, "
            f"got {text[:60]!r}"
        )
    try:
        outcome = float(text.replace(",", ".") if decimal_comma else text)
    except ValueError:
        outcome = TRUTHS.get(text.strip().lower(), math.nan)
    if not math.isfinite(outcome):
        if "," in text and not decimal_comma:
            hint = "; write decimals with a point, or say --decimal-comma"
        raise InputError(f"{where}{name} must be a finite number, got {text[:60]!r}{hint}")
    if abs(outcome) > LARGEST:
        raise InputError(f"{where}{name} must be at most {LARGEST:g} in size, got {text[:60]!r}")
    return outcome


def parse_time(word: str) -> int | None:
    """Milliseconds since 1970 of a date, of seconds or of milliseconds; 0 for no word, None for another word."""
    if not word:
        return 0
    try:
        number = float(word)
        return int(number if abs(number) > LARGEST_SECONDS else 1000 * number)
    except (ValueError, OverflowError):
        pass
    try:
        moment = datetime.fromisoformat(word)
    except ValueError:
        return None
    return int(1000 * (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp())
