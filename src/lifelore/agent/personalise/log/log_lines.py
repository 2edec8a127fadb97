"""The lines of a log: CSV is cut into fields, and each line is found in the columns that the format names."""

import csv
import io
from collections.abc import Iterator
from itertools import chain

import numpy as np

from lifelore.agent.personalise.log.log_columns import WORDS, ColumnReader, Lines
from lifelore.agent.personalise.log.log_format import SEPARATORS, LogFormat
from lifelore.core.errors import InputError

CHUNK = 1 << 16
"""Lines taken in at a time; more need more memory, fewer more time."""


def read_lines(content: bytes, name: str, form: LogFormat) -> Lines:
    """The choices of a file; see `read_log` for its errors."""
    # Some programs begin their UTF-8 with a mark.
    encoding = "utf-8-sig" if form.encoding.lower().replace("-", "").replace("_", "") == "utf8" else form.encoding
    text = io.TextIOWrapper(io.BytesIO(content), encoding, newline="")
    try:
        return _read(iter(text), name, form)
    except UnicodeError:
        known = "UTF-8" if encoding == "utf-8-sig" else form.encoding
        raise InputError(
            f"{name} must be CSV in {known}, got bytes that are not; say --encoding latin-1, or another"
        ) from None


def _read(lines: Iterator[str], name: str, form: LogFormat) -> Lines:
    first = next(lines, "")
    reader = csv.reader(chain([first], lines), strict=True, delimiter=_separator(first, form))
    try:
        header = [column.strip().lower() for column in next(reader, [])]
        places = _places(header, name, form)
        columns = ColumnReader(name, form)
        rows: list[list[str]] = []
        at: list[int] = []
        for fields in reader:
            # Blank lines are none.
            if fields and (fields[0].strip() or any(map(str.strip, fields))):
                rows.append(fields)
                at.append(reader.line_num)
                if len(rows) == CHUNK:
                    _take(columns, rows, at, header, places, name)
                    rows, at = [], []
        if rows:
            _take(columns, rows, at, header, places, name)
    except csv.Error as error:
        raise InputError(f"{name} line {reader.line_num}: not CSV ({error})") from None
    return columns.lines()


def _take(
    columns: ColumnReader,
    rows: list[list[str]],
    at: list[int],
    header: list[str],
    places: dict[str, int],
    name: str,
) -> None:
    if set(map(len, rows)) != {len(header)}:
        fields, line = next(pair for pair in zip(rows, at, strict=True) if len(pair[0]) != len(header))
        raise InputError(f"{name} line {line}: must have {len(header)} fields like the header, got {len(fields)}")
    by_place = list(zip(*rows, strict=True))
    found = [by_place[places[column]] if column in places else None for column in ("outcome", *WORDS)]
    numbers = [by_place[header.index(column)] for column in columns.form.numbers]
    columns.take([*found, *numbers], np.array(at))


def _separator(header: str, form: LogFormat) -> str:
    """The separator that makes the needed columns, a comma where none does."""
    if form.separator is not None:
        return SEPARATORS[form.separator]
    needed = {form.column(column) for column in form.needed}
    for separator in SEPARATORS.values():
        if {word.strip().strip('"').strip().lower() for word in header.split(separator)}.issuperset(needed):
            return separator
    return SEPARATORS["comma"]


def _places(header: list[str], name: str, form: LogFormat) -> dict[str, int]:
    needed = ", ".join(form.column(column) for column in form.needed)
    if not any(header):
        raise InputError(f"{name} must begin with a header that names {needed}, it is empty")
    for own in (*(form.column(column) for column in form.read), *form.numbers):
        if header.count(own) > 1:
            raise InputError(f"{name} must have one column '{own}', its header names {header.count(own)}")
    every = (*(form.column(column) for column in (*form.needed, *form.columns)), *form.numbers)
    missing = [column for column in every if column not in header]
    if missing:
        raise InputError(
            f"{name} must have the columns {needed}, separated by commas; it has no "
            f"{' and no '.join(dict.fromkeys(missing))}, its header is '{','.join(header)[:80]}'; name others "
            "with --columns user=NAME,policy=NAME,outcome=NAME"
        )
    return {column: header.index(form.column(column)) for column in form.read if form.column(column) in header}
