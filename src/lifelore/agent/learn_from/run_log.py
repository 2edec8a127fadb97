"""Runs of a real robot from a CSV file: poses over time, and how they went.

    time      seconds, ascending within a run; also milli-, micro- or nanoseconds since 1970
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
from itertools import chain, pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError, StoreError

NEEDED, OPTIONAL = ("time", "x", "y"), ("run", "heading", "outcome")
NOTHING, BUMP, GOAL, FAILED = "", "bump", "goal", "failed"
OUTCOMES = (BUMP, GOAL, FAILED)
GAP = 10.0
"""Seconds without a pose that end a run in a log without the column run."""
FIRST_CLOCK = 1e9
"""Seconds since 1970: times from here on are of a clock, smaller ones count from the start of a robot."""
_FARTHEST, _LATEST = 1e6, 4e9
"""Metres, and seconds since 1970; a larger coordinate or time is an error of units."""
_MOST_TURNED = 0.2
"""Share of headings beyond 2π from which on they are taken for degrees; fewer are of a robot that turned round."""


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

    def part(self, name: str, part: slice) -> "Run":
        """A part of the poses as a run of its own."""
        return Run(name, self.time[part], self.points[part], self.heading[part], self.outcome[part])

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
            rows = list(_rows(file, str(path)))
    except OSError as error:
        raise StoreError(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path} must be UTF-8 text, got other bytes; convert the file") from None
    if not rows:
        raise InputError(f"{path} must hold at least one pose, got only a header")
    lines, names, outcome, poses = zip(*rows, strict=True)
    time, x, y, heading = np.array(poses).T
    time = _in_seconds(time, lines, str(path))
    turned = int((np.abs(heading) > 2 * np.pi).sum())
    if turned > _MOST_TURNED * (given := int(np.isfinite(heading).sum())):
        raise InputError(
            f"{path}: {turned} of {given} headings are beyond 2π, as degrees are; give radians within one turn"
        )
    whole, name = Run("", time, np.column_stack([x, y]), heading, list(outcome)), np.array(names)
    named, ended = (name[1:] != "") | (name[:-1] != ""), np.isin(outcome[:-1], (GOAL, FAILED))
    ends = np.where(named, name[1:] != name[:-1], ended | (np.diff(time) > GAP))
    for at in np.flatnonzero(~ends & (np.diff(time) < 0))[:1].tolist():
        raise InputError(
            f"{path} line {lines[at + 1]}: time must ascend within a run, got {time[at + 1]:.15g} after "
            f"{time[at]:.15g}; where the clock was set back, begin another run (column run)"
        )
    parts = _parts(ends)
    return [whole.part(names[part.start] or str(number), part) for number, part in enumerate(parts)]


def _in_seconds(time: NDArray[np.float64], lines: Sequence[int], name: str) -> NDArray[np.float64]:
    """Times in seconds; by their size, all of them may be milli-, micro- or nanoseconds since 1970."""
    unit = next((unit for unit in (1e9, 1e6, 1e3) if time.min() >= FIRST_CLOCK * unit), 1.0)
    for at in np.flatnonzero(np.abs(time / unit) > _LATEST)[:1].tolist():
        raise InputError(
            f"{name} line {lines[at]}: time must be seconds, or milli-, micro- or nanoseconds since 1970 in all "
            f"lines, got {time[at]:g}"
        )
    return time / unit


def cut_runs(whole: Run, ends: NDArray[np.bool_]) -> list[Run]:
    """The runs of a log, each of which ends where `ends` (n,) is true; named as the log, with their number."""
    parts = _parts(ends[:-1])
    if len(parts) == 1:
        return [whole]
    return [whole.part(f"{whole.name} {number}", part) for number, part in enumerate(parts)]


def _parts(ends: NDArray[np.bool_]) -> list[slice]:
    """The slices of n poses that end where `ends` (n - 1,) is true, and at the last pose."""
    borders = [0, *(np.flatnonzero(ends) + 1).tolist(), len(ends) + 1]
    return [slice(*pair) for pair in pairwise(borders)]


def _rows(file: Iterable[str], name: str) -> Iterator[tuple[int, str, str, tuple[float, ...]]]:
    """Number of the line, run, outcome, and (time, x, y, heading) of each pose."""
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
                yield reader.line_num, *_pose(row, columns, f"{name} line {reader.line_num}")
    except csv.Error as error:
        raise InputError(f"{name} line {reader.line_num}: is no CSV ({error})") from None


def _pose(row: list[str], columns: list[str], where: str) -> tuple[str, str, tuple[float, ...]]:
    if len(row) != len(columns):
        raise InputError(f"{where}: must have {len(columns)} values, got {len(row)}")
    value = {column: text.strip() for column, text in zip(columns, row, strict=True)}

    def number(column: str, most: float, unit: str) -> float:
        try:
            found = float(value[column])
        except ValueError:
            found = math.nan
        if not abs(found) <= most:
            raise InputError(
                f"{where}: {column} must be a number of {unit}, of magnitude {most:g} at most, got "
                f"{value[column][:40]!r}"
            )
        return found

    outcome = value.get("outcome", "").lower()
    if outcome not in (NOTHING, *OUTCOMES):
        raise InputError(f"{where}: outcome must be empty or one of {', '.join(OUTCOMES)}, got {outcome[:40]!r}")
    heading = number("heading", 1e4, "radians") if value.get("heading") else math.nan
    pose = number("time", 1e9 * _LATEST, "seconds"), *(number(axis, _FARTHEST, "metres") for axis in "xy"), heading
    return value.get("run", ""), outcome, pose
