"""A table in memory (pandas, polars, Arrow, a mapping of columns) as the CSV of a log: both are read alike."""

import csv
import io
from dataclasses import replace
from typing import Any

from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.frame_columns import FrameColumns

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
    if value is None:
        return ""
    return str(int(value)) if isinstance(value, bool) else str(value)
