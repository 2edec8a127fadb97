"""Records of observed moves: passes with their seconds, and refusals, to the minute.

A record of kind "passes" adds. Its slot packs 63 bits: row (16), column (17), action (2), minute since 1970 (26),
quantity (2). Rows and columns count from the lower left corner of the building's first map. Quantities are the
number of passes, the sum of the natural logarithms of their seconds in units of 2⁻²⁰, and the number of refusals.
Limits: 65,536 rows, 131,072 columns, clocks from 1970 to 2097.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.agent.building_record import Joined
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.domains.grids.cell_numbers import COLUMN_BITS, BuildingGrid, cells_in_building, states_in_building
from lifelore.domains.grids.grid_world import MOVES, GridWorld

KIND, VERSION = "passes", 1
UNIT = 2.0**-20
"""Value of 1 in a stored sum of logarithms."""
_RING = np.array([0, 3, 1, 2])
"""Actions in the order of left turns: north, west, south, east."""
_COLUMNS, _MINUTES = 17, 26
_LAST_MINUTE = 2**_MINUTES - 1
N_ACTIONS = 4


class Passes(NamedTuple):
    """Observed moves, a row for one move or for several of the same minute; all (n,).

    move : int64, state · 4 + action
    minute : int64, minutes since 1970 by the robot's clock
    passes : int64, number of moves that led on
    log_seconds : float, sum of the natural logarithms of their seconds
    refusals : int64, number of moves that were refused
    """

    move: NDArray[np.int64]
    minute: NDArray[np.int64]
    passes: NDArray[np.int64]
    log_seconds: NDArray[np.float64]
    refusals: NDArray[np.int64]

    def where(self, chosen: NDArray[np.bool_]) -> "Passes":
        """The chosen rows; `chosen` (n,)."""
        return Passes._make(column[chosen] for column in self)


def observed(
    world: GridWorld, states: ArrayLike, actions: ArrayLike, clock: ArrayLike, seconds: ArrayLike
) -> Passes:
    """Moves as rows, without those that the map of `world` does not have.

    Parameters
    ----------
    world : GridWorld
    states, actions : (n,) int
    clock : (n,) float
        Seconds since 1970 by the robot's clock.
    seconds : (n,) float
        Of each move, above 0; NaN where it was refused.

    Raises
    ------
    InputError
        The arrays differ in length, or a value lies outside its range.
    """
    state, action = np.atleast_1d(np.asarray(states, np.int64)), np.atleast_1d(np.asarray(actions, np.int64))
    time, taken = np.atleast_1d(np.asarray(clock, float)), np.atleast_1d(np.asarray(seconds, float))
    if not len(state) == len(action) == len(time) == len(taken):
        lengths = f"{len(state)}, {len(action)}, {len(time)} and {len(taken)}"
        raise InputError(f"states, actions, clock and seconds must have one length, got {lengths}")
    refused = np.isnan(taken)
    for name, values, right, rule in (
        ("states", state, (state >= 0) & (state < world.n_states), f"lie in [0, {world.n_states})"),
        ("actions", action, (action >= 0) & (action < N_ACTIONS), f"lie in [0, {N_ACTIONS})"),
        (
            "clock",
            time,
            (time >= 0) & (time < 60 * _LAST_MINUTE),
            f"be seconds since 1970 below {60 * _LAST_MINUTE}",
        ),
        ("seconds", taken, refused | ((taken > 0) & np.isfinite(taken)), "be above 0, or NaN for a refused move"),
    ):
        if not right.all():
            raise InputError(f"{name} must {rule}, got {values[~right][0]}; leave such moves out")
    log = np.log(np.where(refused, 1.0, taken))
    rows = Passes(
        state * N_ACTIONS + action, (time // 60).astype(np.int64), (~refused).astype(int), log, refused.astype(int)
    )
    return rows.where(world.neighbour[state, action] >= 0)


def joined(parts: list[Passes]) -> Passes:
    """The rows of all parts in their order; no rows of no parts."""
    empty = [np.zeros(0, kind) for kind in (np.int64, np.int64, np.int64, np.float64, np.int64)]
    return Passes._make(np.concatenate(columns) for columns in zip(empty, *parts, strict=True))


def key_of(world: GridWorld, grid: BuildingGrid) -> str:
    """The key of a building's passes in memory: cells of another size are other moves."""
    return grid.frame if grid.building is None else f"{grid.building}:{round(1000 * world.frame.cell)}"


def to_record(world: GridWorld, grid: BuildingGrid, passes: Passes) -> Record:
    """The rows that lie in the grid of the building's first map, as a record that adds."""
    cell = cells_in_building(world, grid.corner)[passes.move // N_ACTIONS]
    row, column = cell >> COLUMN_BITS, cell & (2**COLUMN_BITS - 1)
    inside = (cell >= 0) & (row < 2**16) & (column < 2**_COLUMNS)
    place = (((row << _COLUMNS) | column) * N_ACTIONS + passes.move % N_ACTIONS)[inside]
    slot = ((place << _MINUTES) | passes.minute[inside]) * 4
    logs = np.rint(passes.log_seconds / UNIT).astype(np.int64)
    values = np.concatenate([each[inside] for each in (passes.passes, logs, passes.refusals)])
    slots, where = np.unique(np.concatenate([slot, slot + 1, slot + 2]), return_inverse=True)
    sums = np.zeros(len(slots), np.int64)
    np.add.at(sums, where, values)
    about = {"world": world.name, "building": grid.building, "cell": world.frame.cell}
    return Record(KIND, key_of(world, grid), VERSION, "add", slots[sums != 0], sums[sums != 0], about)


def from_record(
    world: GridWorld, grid: BuildingGrid, record: Record | None, other: Joined | None = None
) -> Passes:
    """The rows of a record, by state of `world`, without moves that its map does not have.

    If the record is of `other`, a building that was joined to that of `world`, a move into a cell counts as the
    move into the cell at that place, in the nearest of the four directions.
    """
    if record is None:
        return joined([])
    rows, where = np.unique(record.slots >> 2, return_inverse=True)
    sums = np.zeros((len(rows), 3), np.int64)
    sums[where, record.slots & 3] = record.values
    place, minute = rows >> _MINUTES, rows & _LAST_MINUTE
    action, cell = place % N_ACTIONS, place // N_ACTIONS
    row, column = cell >> _COLUMNS, cell & (2**_COLUMNS - 1)
    if other is None:
        state = states_in_building(world, (row << COLUMN_BITS) | column, grid.corner)
    else:
        down, right = MOVES[action].T
        into = other.states(world, grid, row - down, column + right)
        action = _RING[(np.argsort(_RING)[action] + round(other.motion[2] / (np.pi / 2))) % 4]
        # The move back of an action differs in the last bit.
        state = np.where(into >= 0, world.neighbour[into, action ^ 1], -1)
    known = (state >= 0) & (world.neighbour[state, action] >= 0)
    found = Passes._make((state * N_ACTIONS + action, minute, sums[:, 0], sums[:, 1] * UNIT, sums[:, 2]))
    return found.where(known)
