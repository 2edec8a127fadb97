"""Runs of a real robot from a CSV file: poses over time, and how they went.

    time      seconds, ascending within a run
    x, y      metres in the frame of the map
    run       optional: name of the run
    heading   optional: radians, 0 along x
    outcome   optional: bump (the robot touched an obstacle ahead), goal (the run ended at its goal) or failed (the
              run ended elsewhere); empty on all other lines

Without the column `run`, a run ends with an outcome goal or failed, or with a gap of more than `GAP` seconds.
"""

import csv
import hashlib
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError, StoreError

NEEDED, OPTIONAL = ("time", "x", "y"), ("run", "heading", "outcome")
NOTHING, BUMP, GOAL, FAILED = "", "bump", "goal", "failed"
OUTCOMES = (BUMP, GOAL, FAILED)
GAP = 10.0
"""Seconds without a pose that end a run in a log without the column run."""
_FARTHEST, _LATEST = 1e6, 4e9
"""Metres, and seconds since 1970; a larger coordinate or time is an error of units."""


@dataclass(frozen=True, eq=False)
class Run:
    """Poses of one run, in order of time.

    name : of the run, or its number in the file
    time : (n,) seconds, ascending
    points : (n, 2) x and y in metres
    heading : (n,) radians; NaN where the log has none
    outcome : n outcomes, each "" or one of `OUTCOMES`
    """

    name: str
    time: NDArray[np.float64]
    points: NDArray[np.float64]
    heading: NDArray[np.float64]
    outcome: Sequence[str]

    @property
    def reached_goal(self) -> bool:
        """Whether the run ended at its goal."""
        return self.outcome[-1] == GOAL

    @property
    def digest(self) -> str:
        """Hash of the poses and outcomes: equal runs have equal digests, in whatever file."""
        parts = [
            np.column_stack([self.time, self.points, self.heading]).tobytes(),
            "\0".join(self.outcome).encode(),
        ]
        return hashlib.sha256(b"".join(parts)).hexdigest()[:32]


@dataclass(frozen=True)
class _Pose:
    """A line of the log."""

    line: int
    run: str
    time: float
    x: float
    y: float
    heading: float
    outcome: str


def read_runs(path: str | Path) -> list[Run]:
    """The runs of a CSV file, in the order in which they begin.

    Raises
    ------
    NotFoundError
        There is no such file.
    InputError
        A line breaks its rule, or the file has no pose; the message gives the number of the line.
    StoreError
        The file cannot be read.
    """
    if not Path(path).is_file():
        raise NotFoundError(f"runs '{path}' does not exist; give a CSV file with the columns {', '.join(NEEDED)}")
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            runs = _runs(_poses(file, str(path)), str(path))
    except OSError as error:
        raise StoreError(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path} must be UTF-8 text, got other bytes; convert the file") from None
    if not runs:
        raise InputError(f"{path} must hold at least one pose, got only a header")
    return runs


def cut_runs(whole: Run, ends: NDArray[np.bool_]) -> list[Run]:
    """The runs of a log, each of which ends where `ends` (n,) is true; named as the log, with their number."""
    lasts = [*np.flatnonzero(ends[:-1]).tolist(), len(whole.time) - 1]
    parts = [slice(a, b + 1) for a, b in zip([0, *(last + 1 for last in lasts)], lasts, strict=False)]
    return [
        Run(f"{whole.name} {number}" if len(parts) > 1 else whole.name,
            whole.time[part], whole.points[part], whole.heading[part], whole.outcome[part])
        for number, part in enumerate(parts)
    ]  # fmt: skip


def _poses(file: Iterable[str], name: str) -> Iterator[_Pose]:
    lines = iter(file)
    header = next(lines, "")
    separator = max(",;\t", key=header.count)
    # Empty lines are skipped, and `line_num` counts them.
    reader = csv.reader(chain([header], lines), delimiter=separator, strict=True)
    try:
        columns = [column.strip().lower() for column in next(reader, [])]
        missing = [column for column in NEEDED if column not in columns]
        if missing:
            raise InputError(f"{name} line 1: column '{missing[0]}' is missing; it needs {', '.join(NEEDED)}")
        for row in reader:
            if row:
                yield _pose(row, columns, reader.line_num, name)
    except csv.Error as error:
        raise InputError(f"{name} line {reader.line_num}: is no CSV ({error})") from None


def _pose(row: list[str], columns: list[str], line: int, name: str) -> _Pose:
    if len(row) != len(columns):
        raise InputError(f"{name} line {line}: must have {len(columns)} values, got {len(row)}")
    value = {column: text.strip() for column, text in zip(columns, row, strict=True)}

    def number(column: str, most: float) -> float:
        try:
            found = float(value[column])
        except ValueError:
            found = math.nan
        if not abs(found) <= most:
            raise InputError(f"{name} line {line}: {column} must be a number of magnitude {most:g} at most, "
                             f"got {value[column][:40]!r}")  # fmt: skip
        return found

    outcome = value.get("outcome", "").lower()
    if outcome not in (NOTHING, *OUTCOMES):
        raise InputError(f"{name} line {line}: outcome must be empty or one of {', '.join(OUTCOMES)}, "
                         f"got {outcome[:40]!r}")  # fmt: skip
    heading = number("heading", 1e4) if value.get("heading") else math.nan
    time, x, y = number("time", _LATEST), number("x", _FARTHEST), number("y", _FARTHEST)
    return _Pose(line, value.get("run", ""), time, x, y, heading, outcome)


def _runs(poses: Iterable[_Pose], name: str) -> list[Run]:
    runs: list[list[_Pose]] = []
    for pose in poses:
        last = runs[-1][-1] if runs else None
        if last is None or _begins(pose, last):
            runs.append([])
        elif pose.time < last.time:
            raise InputError(f"{name} line {pose.line}: time must ascend within a run, got {pose.time:g} after "
                             f"{last.time:g}")  # fmt: skip
        runs[-1].append(pose)
    return [_run(run, number) for number, run in enumerate(runs)]


def _begins(pose: _Pose, last: _Pose) -> bool:
    if pose.run or last.run:
        return pose.run != last.run
    return last.outcome in (GOAL, FAILED) or pose.time - last.time > GAP


def _run(poses: list[_Pose], number: int) -> Run:
    columns = np.array([(pose.time, pose.x, pose.y, pose.heading) for pose in poses])
    outcome = [pose.outcome for pose in poses]
    return Run(poses[0].run or str(number), columns[:, 0], columns[:, 1:3], columns[:, 3], outcome)
