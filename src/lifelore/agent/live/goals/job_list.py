"""Reads a job list: a CSV file of destinations to go to, in the order of their times."""

import csv
import math
from dataclasses import dataclass
from datetime import datetime, time
from pathlib import Path

from lifelore.agent.live.goals.destinations import Destination, Point
from lifelore.core.errors import InputError

COLUMNS = ("time", "name", "x", "y")


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
        The file is missing or no such CSV; the message names the line.
    """
    rows = _rows(path)
    if not rows:
        raise InputError(f"goals: {path} is empty; its first line must name columns of {', '.join(COLUMNS)}")
    header = [name.strip().lower() for name in rows[0][1]]
    _check_header(path, header)
    jobs = [_job(path, line, header, row) for line, row in rows[1:]]
    if not jobs:
        raise InputError(f"goals: {path} has no job below its header; write one line for each job")
    _check_names(path, jobs)
    if all(job.time is None for job in jobs):
        return tuple(jobs)
    keys = [_time_key(path, job) for job in jobs]
    for job, key in zip(jobs, keys, strict=True):
        if key[0] != keys[0][0]:
            raise _bad(path, job.line, f"time must be {keys[0][0]} as in line {jobs[0].line}, got '{job.time}'")
    return tuple(job for _, job in sorted(zip(keys, jobs, strict=True), key=lambda pair: pair[0]))


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


def _job(path: str | Path, line: int, header: list[str], row: list[str]) -> Job:
    if len(row) != len(header):
        raise _bad(path, line, f"must have {len(header)} fields ({','.join(header)}), got {len(row)}")
    field = {name: text.strip() for name, text in zip(header, row, strict=True)}
    x, y, name = field.get("x", ""), field.get("y", ""), field.get("name") or None
    if not x and not y and name is None:
        raise _bad(path, line, "must have x and y, or a name" if "name" in header else "must have x and y")
    point = (_number(path, line, "x", x), _number(path, line, "y", y)) if x or y else None
    try:
        return Job(Destination(point, name), field.get("time") or None, line)
    except InputError as error:
        raise _bad(path, line, str(error)) from None


def _number(path: str | Path, line: int, column: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise _bad(path, line, f"{column} must be a number of metres, got '{text[:40]}'")
    return number


def _check_names(path: str | Path, jobs: list[Job]) -> None:
    first: dict[str, Job] = {}
    for job in jobs:
        end = job.destination
        if end.name is None or end.point is None:
            continue
        before = first.setdefault(end.name, job)
        if before.destination.point != end.point:
            raise _bad(path, job.line, f"name '{end.name}' has another position in line {before.line}")


def _time_key(path: str | Path, job: Job) -> tuple:
    """Kind of the time, and a value to sort by."""
    text = job.time
    if text is None:
        raise _bad(path, job.line, "time is missing, but other lines have one; give every line a time, or none")
    try:
        seconds = float(text)
        if math.isfinite(seconds):
            return "a number of seconds", seconds
    except ValueError:
        pass
    for kind, parse in (("a clock time", time.fromisoformat), ("a date", datetime.fromisoformat)):
        try:
            value = parse(text)
        except ValueError:
            continue
        return kind + (" with a time zone" if value.tzinfo else ""), value
    raise _bad(path, job.line, f"time must be a number of seconds, HH:MM or an ISO 8601 date, got '{text[:40]}'")


def _bad(path: str | Path, line: int, reason: str) -> InputError:
    return InputError(f"goals: {path} line {line}: {reason}")
