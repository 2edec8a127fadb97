"""Logs of choices and their outcomes: CSV with a header and one choice a line.

    user      who it was for; any text
    policy    what was chosen: a configuration, a variant, a behaviour
    outcome   how well it went, a number, larger is better; empty: not yet known, the line is passed over
    type      optional: what kind of user it is, if known; may be empty on some lines
    context   optional: what is known of a user before the first choice (device, country, shop)

Commas, semicolons or tabs lie between columns, as the header has them; capitals in column names do not matter.
Other columns are passed over. Several logs are read as one.
"""

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError, StoreError

NEEDED = ("user", "policy", "outcome")
OPTIONAL = ("type", "context")
SEPARATORS = (",", ";", "\t")
LONGEST = 200


@dataclass(frozen=True, eq=False)
class ReuseLog:
    """Choices whose outcome is known, one a row.

    Parameters
    ----------
    users, policies, types, contexts : (n,) list of str
        Types and contexts are "" where the log does not say.
    outcomes : (n,) float64
        Finite.
    pending : int
        Lines passed over because their outcome is not known.
    """

    users: list[str]
    policies: list[str]
    types: list[str]
    contexts: list[str]
    outcomes: NDArray[np.float64]
    pending: int

    def __len__(self) -> int:
        return len(self.users)

    @property
    def says_types(self) -> bool:
        """Whether any line names a type."""
        return any(self.types)

    def of_users(self, names: Sequence[str]) -> dict[str, str]:
        """The last word of a column on each user, where it says one; `names` is ``types`` or ``contexts``."""
        return {user: name for user, name in zip(self.users, names, strict=True) if name}


def read_log(paths: Sequence[str | Path]) -> ReuseLog:
    """Read logs as one.

    Raises
    ------
    NotFoundError
        There is no such file.
    InputError
        A column is missing, a line breaks its rule (the message says which), no outcome is known, or a log is
        given twice.
    StoreError
        The disk refuses.
    """
    places = [Path(path).resolve() for path in paths]
    for number, path in enumerate(paths):
        if places[number] in places[:number]:
            raise InputError(f"log '{path}' is given twice; its lines would count twice, leave one out")
    rows = [row for path in paths for row in _rows(Path(path))]
    known = [row for row in rows if row[2] is not None]
    if not known:
        raise InputError(f"{', '.join(map(str, paths))} must hold at least one line with an outcome, got none")
    users, policies, outcomes, types, contexts = (list(column) for column in zip(*known, strict=True))
    return ReuseLog(users, policies, types, contexts, np.array(outcomes, np.float64), len(rows) - len(known))


_Row = tuple[str, str, float | None, str, str]


def _rows(path: Path) -> Iterator[_Row]:
    if not path.is_file():
        what = "is no file" if path.exists() else "does not exist"
        raise NotFoundError(f"log '{path}' {what}; give a CSV file")
    try:
        # Some programs begin their UTF-8 with a mark.
        with path.open(encoding="utf-8-sig", newline="") as file:
            yield from _read(file, str(path))
    except UnicodeDecodeError:
        raise InputError(f"{path} must be CSV in UTF-8, got bytes that are not") from None
    except OSError as error:
        raise StoreError(f"cannot read {path}: {error.strerror}") from None


def _read(lines: Iterator[str], name: str) -> Iterator[_Row]:
    first = next(lines, "")
    reader = csv.reader(chain([first], lines), strict=True, delimiter=_separator(first))
    try:
        header = [column.strip().lower() for column in next(reader, [])]
        places = _places(header, name)
        for fields in reader:
            if any(field.strip() for field in fields):
                yield _row(fields, header, places, f"{name} line {reader.line_num}")
    except csv.Error as error:
        raise InputError(f"{name} line {reader.line_num}: not CSV ({error})") from None


def _separator(header: str) -> str:
    """What the columns needed are separated by, a comma where none fits."""
    for separator in SEPARATORS:
        if {word.strip().strip('"').strip().lower() for word in header.split(separator)}.issuperset(NEEDED):
            return separator
    return SEPARATORS[0]


def _places(header: list[str], name: str) -> dict[str, int]:
    if not any(header):
        raise InputError(f"{name} must begin with a header that names {', '.join(NEEDED)}, it is empty")
    for column in (*NEEDED, *OPTIONAL):
        if header.count(column) > 1:
            raise InputError(f"{name} must have one column '{column}', its header names {header.count(column)}")
    missing = [column for column in NEEDED if column not in header]
    if missing:
        raise InputError(
            f"{name} must have the columns {', '.join(NEEDED)}, separated by commas; it has no "
            f"{' and no '.join(missing)}, its header is '{','.join(header)[:80]}'"
        )
    return {column: header.index(column) for column in (*NEEDED, *OPTIONAL) if column in header}


def _row(fields: list[str], header: list[str], places: dict[str, int], where: str) -> _Row:
    if len(fields) != len(header):
        raise InputError(f"{where}: must have {len(header)} fields like the header, got {len(fields)}")
    record = {column: fields[place].strip() for column, place in places.items()}
    for column in ("user", "policy"):
        check_word(f"{where}: {column}", record[column])
    for column in OPTIONAL:
        if record.get(column):
            check_word(f"{where}: {column}", record[column])
    hint = "; leave it empty if it is not known"
    outcome = read_outcome(record["outcome"], f"{where}: ", hint) if record["outcome"] else None
    return record["user"], record["policy"], outcome, record.get("type", ""), record.get("context", "")


def check_word(what: str, word: str) -> str:
    """`word` itself, if it is 1 to 200 printable characters."""
    if not 0 < len(word) <= LONGEST or not word.isprintable():
        raise InputError(f"{what} must be 1 to {LONGEST} printable characters, got {word[:60]!r}")
    return word


def read_outcome(text: str, where: str = "", hint: str = "") -> float:
    """A finite number; InputError for anything else."""
    try:
        outcome = float(text)
    except ValueError:
        outcome = math.nan
    if not math.isfinite(outcome):
        hint = "; write decimals with a point" if "," in text else hint
        raise InputError(f"{where}outcome must be a finite number, got {text[:60]!r}{hint}")
    return outcome
