"""Reads a job list: a CSV file of destinations to go to, in the order of their times."""

import csv
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime, time
from pathlib import Path
from typing import TypeVar

from lifelore.agent.live.goals.destinations import Destination, Point
from lifelore.core.errors import InputError, NotFoundError

COLUMNS = ("time", "name", "x", "y")
T = TypeVar("T")
R = TypeVar("R")
SHOWN = 10
"""Number of wrong lines, at most, that a message names."""


@dataclass(frozen=True)
class Job:
    """A task of a job list.

    destination : the goal: a point, a name, or both
    time : as written, None without a time
    line : line of the file, counted from 1
    """

    destination: Destination
    time: str | None = None
    line: int = 0


def read_jobs(path: str | Path) -> tuple[Job, ...]:
    """The jobs of a CSV file, sorted by time; jobs without times, or with equal times, in the order of the file.

    The first line names the columns, in any order: ``x`` and ``y`` (metres of the map's frame), ``name`` or both,
    and optionally ``time``. A time is a number of seconds, a clock time (``08:30``) or a date with time in ISO
    8601, the same kind in all lines. A line with a name alone means the point of that name in another line, or in
    memory.

    Raises
    ------
    InputError
        The file is missing or no such CSV; the message names up to ten wrong lines.
    """
    rows = _rows(path)
    if not rows:
        raise InputError(f"goals: {path} is empty; its first line must name columns of {', '.join(COLUMNS)}")
    header = [name.strip().lower() for name in rows[0][1]]
    _check_header(path, header)
    rows = rows[1:]
    jobs = for_each(lambda row: _job(row[0], header, row[1]), rows, f"goals: {path} ")
    if not jobs:
        raise InputError(f"goals: {path} has no job below its header; write one line for each job")
    first = {job.destination.name: job for job in reversed(jobs) if job.destination.point is not None}
    for_each(lambda job: _check_name(job, first), jobs, f"goals: {path} ")
    if all(job.time is None for job in jobs):
        return tuple(jobs)
    keys = for_each(_time_key, jobs, f"goals: {path} ")
    for_each(
        lambda pair: _check_kind(pair, keys[0][0], jobs[0].line),
        list(zip(keys, jobs, strict=True)),
        f"goals: {path} ",
    )
    return tuple(job for _, job in sorted(zip(keys, jobs, strict=True), key=lambda pair: pair[0]))


def for_each(check: Callable[[T], R], items: Sequence[T], before: str = "") -> list[R]:
    """The results of `check`; its errors of all items become one.

    Raises
    ------
    InputError, NotFoundError
        Of the only wrong item; or an `InputError` with the first `SHOWN` messages. `before` begins the message.
    """
    results, wrong = [], []
    for item in items:
        try:
            results.append(check(item))
        except (InputError, NotFoundError) as error:
            wrong.append(error)
    if not wrong:
        return results
    more = f"; {len(wrong)} lines are wrong in all" if len(wrong) > SHOWN else ""
    message = before + "; ".join(str(error) for error in wrong[:SHOWN]) + more
    raise type(wrong[0])(message) if len(wrong) == 1 else InputError(message)


def named_points(jobs: tuple[Job, ...]) -> dict[str, Point]:
    """The points of the names that the jobs define."""
    ends = [job.destination for job in jobs]
    return {end.name: end.point for end in ends if end.name is not None and end.point is not None}


def _rows(path: str | Path) -> list[tuple[int, list[str]]]:
    """The lines that are not blank, with their numbers."""
    try:
        with Path(path).open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file, strict=True)
            return [(reader.line_num, row) for row in reader if any(field.strip() for field in row)]
    except OSError as error:
        raise InputError(f"goals: cannot read {path}: {error.strerror}; give a CSV file") from None
    except (UnicodeDecodeError, csv.Error, ValueError) as error:
        raise InputError(f"goals: {path} is not CSV in UTF-8: {error}; give a CSV file") from None


def _check_header(path: str | Path, header: list[str]) -> None:
    unknown = [name for name in header if name not in COLUMNS]
    if unknown or len(set(header)) != len(header):
        raise InputError(
            f"goals: {path} line 1 must name columns of {', '.join(COLUMNS)}, each at most once, "
            f"got '{','.join(header)[:80]}'"
        )
    if "name" not in header and not {"x", "y"} <= set(header):
        raise InputError(f"goals: {path} line 1 must have the columns x and y, or name, got '{','.join(header)}'")
    if ("x" in header) != ("y" in header):
        raise InputError(f"goals: {path} line 1 must have both columns x and y, got '{','.join(header)}'")


def _job(line: int, header: list[str], row: list[str]) -> Job:
    if len(row) != len(header):
        raise _bad(line, f"must have {len(header)} fields ({','.join(header)}), got {len(row)}")
    field = {name: text.strip() for name, text in zip(header, row, strict=True)}
    x, y, name = field.get("x", ""), field.get("y", ""), field.get("name") or None
    if not x and not y and name is None:
        raise _bad(line, "must have x and y, or a name" if "name" in header else "must have x and y")
    point = (_number(line, "x", x), _number(line, "y", y)) if x or y else None
    try:
        return Job(Destination(point, name), field.get("time") or None, line)
    except InputError as error:
        raise _bad(line, str(error)) from None


def _number(line: int, column: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise _bad(line, f"{column} must be a number of metres, got '{text[:40]}'")
    return number


def _check_name(job: Job, first: dict[str | None, Job]) -> None:
    """A name has one position; `first` is the first job with a position for each name."""
    end = job.destination
    if end.name is not None and end.point is not None and first[end.name].destination.point != end.point:
        raise _bad(job.line, f"name '{end.name}' has another position in line {first[end.name].line}")


def _check_kind(keyed: tuple[tuple, Job], kind: str, line: int) -> None:
    """All times are of one kind, that of the first job in `line`."""
    (own, _), job = keyed
    if own != kind:
        raise _bad(job.line, f"time must be {kind} as in line {line}, got '{job.time}'")


def _time_key(job: Job) -> tuple:
    """Kind of the time, and a value to sort by."""
    if job.time is None:
        raise _bad(job.line, "time is missing, but other lines have one; give every line a time, or none")
    try:
        value = parsed_time(job.time)
    except ValueError:
        raise _bad(
            job.line, f"time must be a number of seconds, HH:MM or an ISO 8601 date, got '{job.time[:40]}'"
        ) from None
    if not isinstance(value, time | datetime):
        return "a number of seconds", value
    kind = "a date" if isinstance(value, datetime) else "a clock time"
    return kind + (" with a time zone" if value.tzinfo else ""), value


def parsed_time(text: str) -> float | time | datetime:
    """Seconds of the day, a clock time or a date, as a job list writes them.

    Raises
    ------
    ValueError
        The text is none of them.
    """
    for parse in (float, time.fromisoformat, datetime.fromisoformat):
        try:
            value = parse(text)
        except ValueError:
            continue
        if not isinstance(value, float) or math.isfinite(value):
            return value
    raise ValueError(f"no time: {text}")


def _bad(line: int, reason: str) -> InputError:
    return InputError(f"line {line}: {reason}")
