"""Expected seconds of each move at a clock, from passes: a robust mean that is shrunk level by level.

log seconds = log(cell / speed) + pace of the building + neighbourhood + move + hour of the building
+ hour of the neighbourhood + hour of the move + noise.

Each level explains what the levels before it left: its effect is the sum of weighted residuals divided by the sum
of weights plus a strength. A level without passes adds nothing. Weights halve with age, so that a corridor that
has become slow is noticed. Neighbouring hours are smoothed; hours of weekend days are hours of their own.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.travel.passes import Passes
from lifelore.domains.grids.grid_world import GridWorld

SPEED = 0.5
"""Metres a second where no move of the building was observed."""
BLOCK_M = 4.0
"""Side of a neighbourhood in metres: a piece of a corridor."""
DAY = 24 * 60
N_HOURS = 48
"""Hours of a weekday, then hours of a weekend day."""
LARGEST = 1.5
"""Residuals of log seconds beyond this count as this: a robot that waited an hour is no slow corridor."""


class Level(NamedTuple):
    """A level of the predictor.

    by : what its groups are: the building, a neighbourhood ("block") or a move
    hourly : whether each hour of the day is a group of its own
    half_life : days after which a pass has half its weight
    strength : number of passes without effect that each group has before any pass
    """

    by: str
    hourly: bool
    half_life: float
    strength: float


LEVELS = (
    Level("building", False, 60.0, 1.0),
    Level("block", False, 30.0, 2.0),
    Level("move", False, 14.0, 2.0),
    Level("building", True, 60.0, 20.0),
    Level("block", True, 60.0, 4.0),
    Level("move", True, 60.0, 4.0),
)


def nominal_seconds(world: GridWorld) -> float:
    """Seconds of a move of one cell at `SPEED`."""
    return world.frame.cell / SPEED


def expected_seconds(world: GridWorld, passes: Passes, clock: float) -> NDArray[np.float64]:
    """Expected seconds (n_states, 4) of each move at `clock`, in seconds since 1970; finite and above 0."""
    rows = passes.where(passes.passes > 0)
    minute = clock / 60
    left = rows.log_seconds / rows.passes - np.log(nominal_seconds(world))
    age = np.maximum(minute - rows.minute, 0) / DAY
    hour, now = hour_of(rows.minute), int(hour_of(np.array([int(minute)]))[0])
    groups = _groups(world)
    log = np.full(world.neighbour.size, np.log(nominal_seconds(world)))
    for level in LEVELS:
        group = groups[level.by]
        weight = rows.passes * 0.5 ** (age / level.half_life)
        effect = _effects(level, group[rows.move], hour, weight, left, int(group.max()) + 1)
        left = np.clip(left - effect[group[rows.move], hour if level.hourly else 0], -LARGEST, LARGEST)
        log += effect[group, now if level.hourly else 0]
    total = rows.passes.sum()
    variance = (rows.passes * left**2).sum() / total if total > 1 else 0.0
    return np.exp(log + variance / 2).reshape(world.neighbour.shape)


def _groups(world: GridWorld) -> dict[str, NDArray[np.int64]]:
    """The group of each move, (n_states · 4,), by what groups are."""
    side = max(round(BLOCK_M / world.frame.cell), 1)
    rows, columns = world.cells.T.astype(np.int64) // side
    block = np.repeat(rows * (columns.max() + 1) + columns, world.neighbour.shape[1])
    moves = np.arange(world.neighbour.size)
    return {"building": np.zeros_like(moves), "block": block, "move": moves}


def hour_of(minute: NDArray[np.int64]) -> NDArray[np.int64]:
    """Hour 0 to 23 on weekdays, 24 to 47 on Saturdays and Sundays; 1970 began on a Thursday."""
    weekend = (minute // DAY + 3) % 7 >= 5
    return minute % DAY // 60 + 24 * weekend


def _effects(
    level: Level,
    group: NDArray[np.int64],
    hour: NDArray[np.int64],
    weight: NDArray[np.float64],
    left: NDArray[np.float64],
    n: int,
) -> NDArray[np.float64]:
    """The effect of each group, (n, 48) or (n, 1)."""
    width = N_HOURS if level.hourly else 1
    slot = group * width + (hour if level.hourly else 0)
    sums, counts = summed(slot, weight * left, (n, width)), summed(slot, weight, (n, width))
    if level.hourly:
        sums, counts = smoothed_hours(sums), smoothed_hours(counts)
    return sums / (counts + level.strength)


def summed(slot: NDArray[np.int64], values: NDArray[np.float64], shape: tuple[int, int]) -> NDArray[np.float64]:
    """The sum of the values of each slot, a table of `shape` in row order; `slot` and `values` (n,)."""
    return np.bincount(slot, values, minlength=shape[0] * shape[1]).reshape(shape).astype(np.float64)


def smoothed_hours(by_hour: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each hour with half of the hour before it and half of the next, around the clock; `by_hour` (n, 48)."""
    days = by_hour.reshape(-1, 2, 24)
    return (days + 0.5 * (np.roll(days, 1, axis=2) + np.roll(days, -1, axis=2))).reshape(by_hour.shape)
