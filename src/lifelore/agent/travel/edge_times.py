"""Typical seconds of each move at a clock, from passes: effects that are shrunk level by level.

    log seconds = log(cell / speed) + pace of the building
                  + neighbourhood + cell                               always
                  + neighbourhood + cell, in periods of three days     drift
                  + neighbourhood + cell, by hour of the day           rush hours
                  + noise

The cell is the cell that the move enters. An effect is the sum of the weighted residuals of its group, divided by
the sum of the weights plus a strength, so that groups with few passes have small effects. Residuals are what all
other levels leave (backfitting). Each is clipped, so that a robot that waited an hour makes no slow corridor.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from lifelore.agent.travel.passes import Passes
from lifelore.domains.grids.grid_world import GridWorld

SPEED = 0.5
"""Metres a second where no move of the building was observed."""
DAY = 24 * 60
"""Minutes of a day."""
N_HOURS = 48
"""Hours of a weekday, then hours of a weekend day."""
PERIOD, N_PERIODS = 3, 16
"""Days of a period, counted back from the clock, and number of periods; older passes belong to the last one."""
WIDTHS = {"always": 1, "hour": N_HOURS, "period": N_PERIODS}
"""Number of groups that a cell has, by axis of a level."""
HALF_LIFE = 60.0
"""Days after which a pass has half its weight; twice or half as many change little."""
NEAR = 3
"""Moves from a cell to the farthest cell of its neighbourhood; each move away has half the weight."""
LARGEST = 0.7
"""Residuals of log seconds beyond this count as this."""
SWEEPS = 2
"""Sweeps over all levels; more change little."""


class Level(NamedTuple):
    """A level of the predictor.

    near : whether passes of the neighbourhood count, or those of the cell alone
    axis : "always", "hour" or "period": whether each hour, or each period of days, is a group of its own
    strength : number of passes without effect that each group has before any pass
    """

    near: bool
    axis: str
    strength: float


LEVELS = (
    Level(True, "always", 1.0),
    Level(False, "always", 2.0),
    Level(True, "period", 6.0),
    Level(False, "period", 4.0),
    Level(True, "hour", 6.0),
    Level(False, "hour", 6.0),
)
"""Chosen on seven simulated lives; twice or half a strength changes little."""


def typical_seconds(world: GridWorld, passes: Passes, clock: float) -> NDArray[np.float64]:
    """The seconds (n_states, 4) below which half of the passes at `clock` stay; finite and above 0.

    Moves into one cell share them. `clock` is in seconds since 1970; passes later than it count as new.
    """
    rows, nominal, minute = passes.where(passes.passes > 0), world.frame.cell / SPEED, int(clock // 60)
    if not len(rows.move):
        return np.full(world.neighbour.shape, nominal)
    # Tables have a row for each cell that was entered, and a column for each group of the axis.
    entered, cell = np.unique(world.neighbour.ravel()[rows.move], return_inverse=True)
    alone = sparse.csr_matrix(
        (np.ones(len(entered)), (entered, np.arange(len(entered)))), (world.n_states, len(entered))
    )
    near = _neighbourhoods(world, alone)
    around = {False: (alone, alone[entered]), True: (near, near[entered])}
    age = np.maximum(minute - rows.minute, 0) / DAY
    weight = rows.passes * 0.5 ** (age / HALF_LIFE)
    period = np.minimum(age / PERIOD, N_PERIODS - 1).astype(np.int64)
    axes = {"always": np.zeros_like(period), "hour": hour_of(rows.minute), "period": period}
    now = {"always": 0, "hour": int(hour_of(np.array(minute))), "period": 0}
    # Groups in which nothing was observed change nothing: the tables hold the others, and that of the clock, last.
    used = {axis: np.append(np.unique(groups), now[axis]) for axis, groups in axes.items()}
    column = {axis: np.searchsorted(used[axis][:-1], groups) for axis, groups in axes.items()}

    def by_group(axis: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
        slot, shape = cell * WIDTHS[axis] + axes[axis], (len(entered), WIDTHS[axis])
        table = summed(slot, values, shape)
        smooth = smoothed_hours(table) if axis == "hour" else _smoothed(np.pad(table, ((0, 0), (1, 1))))
        return smooth[:, used[axis]]

    counts = {axis: by_group(axis, weight) for axis in WIDTHS}
    left = rows.log_seconds / rows.passes - np.log(nominal)
    pace = (rows.passes @ left) / (rows.passes.sum() + 1)
    left -= pace
    explained, log = np.zeros((len(LEVELS), len(left))), np.zeros((len(LEVELS), world.n_states))
    for _ in range(SWEEPS):
        for place, (is_near, axis, strength) in enumerate(LEVELS):
            left += explained[place]
            sums, n = by_group(axis, weight * np.clip(left, -LARGEST, LARGEST)), counts[axis]
            everywhere, where_entered = around[is_near]
            explained[place] = _shrunk(where_entered, sums, n, strength)[cell, column[axis]]
            log[place] = _shrunk(everywhere, sums[:, -1], n[:, -1], strength)
            left -= explained[place]
    by_cell = nominal * np.exp(pace + log.sum(axis=0))
    return np.where(world.neighbour >= 0, by_cell[world.neighbour], nominal)


def hour_of(minute: NDArray[np.int64]) -> NDArray[np.int64]:
    """Hour 0 to 23 on weekdays, 24 to 47 on Saturdays and Sundays; 1970 began on a Thursday."""
    weekend = (minute // DAY + 3) % 7 >= 5
    return minute % DAY // 60 + 24 * weekend


def summed(slot: NDArray[np.int64], values: NDArray[np.float64], shape: tuple[int, int]) -> NDArray[np.float64]:
    """The sum of the values of each slot, a table of `shape` in row order; `slot` and `values` (n,)."""
    return np.asarray(np.bincount(slot, values, shape[0] * shape[1]).reshape(shape), np.float64)


def smoothed_hours(by_hour: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each hour with half of the hour before it and half of the next, around the clock; `by_hour` (n, 48)."""
    days = by_hour.reshape(-1, 2, 24)
    return _smoothed(np.concatenate([days[..., -1:], days, days[..., :1]], axis=2)).reshape(by_hour.shape)


def _smoothed(padded: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each group but the first and the last, with half of the one before it and half of the next."""
    return padded[..., 1:-1] + 0.5 * (padded[..., :-2] + padded[..., 2:])


def _neighbourhoods(world: GridWorld, alone: sparse.csr_matrix) -> sparse.csr_matrix:
    """Weight (n_states, n) of each of n cells in the neighbourhood of each cell, along moves of the map.

    `alone` is 1 where the cells are the same.
    """
    start, move = np.nonzero(world.neighbour >= 0)
    beside = sparse.csr_matrix(
        (np.full(len(start), 0.5), (start, world.neighbour[start, move])), (world.n_states, world.n_states)
    )
    near = alone
    for _ in range(NEAR):
        near = near + beside @ near
    return near


def _shrunk(
    around: sparse.csr_matrix, sums: NDArray[np.float64], counts: NDArray[np.float64], strength: float
) -> NDArray[np.float64]:
    """Effects of the cells of `around` (cells, n), from sums and counts of n entered cells."""
    return (around @ sums) / (around @ counts + strength)
