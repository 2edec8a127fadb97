"""What memory knows about driving in one building: seconds of each move by hour, and moves that were refused.

    travel = Travel.recalled(world, grid, memory)
    travel.observe(states, actions, clock, seconds)   # after each drive
    costs = travel.costs(clock)                       # seconds, and seconds to plan with

Memory adds what is observed, so that any robots in any order give the same knowledge.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter

from lifelore.agent.building_record import joined_buildings
from lifelore.agent.travel import passes as records
from lifelore.agent.travel.blocked_moves import blocked_probability
from lifelore.agent.travel.edge_times import typical_seconds
from lifelore.agent.travel.move_costs import MoveCosts
from lifelore.agent.travel.passes import Passes, joined, observed
from lifelore.core.protocols import Record
from lifelore.domains.grids.cell_numbers import BuildingGrid
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.memory import Memory


@dataclass
class Travel:
    """Observed moves of one building, and what is expected from them.

    Parameters
    ----------
    world : GridWorld
        States and actions are its own.
    grid : BuildingGrid
        Where the world lies in the grid of the building's first map.
    """

    world: GridWorld
    grid: BuildingGrid
    _parts: list[Passes] = field(default_factory=list, repr=False)
    _stored: int = field(default=0, repr=False)

    @classmethod
    def recalled(cls, world: GridWorld, grid: BuildingGrid, memory: Memory) -> "Travel":
        """The knowledge that memory holds of this building; moves that the map no longer has are left out."""
        parts = [records.from_record(world, grid, _remembered(world, grid, memory))]
        for key, one in joined_buildings(memory).items():
            if one.home.key == grid.building:
                record = _remembered(world, grid._replace(building=key), memory)
                parts.append(records.from_record(world, grid, record, one))
        return cls(world, grid, _parts=parts, _stored=len(parts))

    def observe(self, states: ArrayLike, actions: ArrayLike, clock: ArrayLike, seconds: ArrayLike) -> None:
        """Take in moves; those that the map does not have are left out.

        Parameters
        ----------
        states, actions : (n,) int
        clock : (n,) float
            Seconds since 1970 by the robot's clock, when the move began. Hours of the day are hours of this clock.
        seconds : (n,) float
            Of each move, above 0; NaN where it was refused.

        Raises
        ------
        InputError
            The arrays differ in length, or a value lies outside its range.
        """
        self._parts.append(observed(self.world, states, actions, clock, seconds))

    def news(self) -> list[Record]:
        """A record of the observations since the last call, for memory; an empty list where there are none.

        Cells left of or below the building's first map are used, and not stored.
        """
        new, self._stored = joined(self._parts[self._stored :]), len(self._parts)
        record = records.to_record(self.world, self.grid, new)
        return [record] if len(record.slots) else []

    @property
    def passes(self) -> Passes:
        """All observations of moves that the map has."""
        return joined(self._parts)

    def seconds(self, clock: float) -> NDArray[np.float64]:
        """Typical seconds (n_states, 4) of each move at `clock`, also of those that are likely to be refused.

        Half of the passes take longer (the median); rare long waits do not count, so that sums over a way are some
        percent short. Moves into one cell share them. Moves without observations get the seconds of their
        surroundings and of the building; the nominal seconds (cell side divided by 0.5 m/s) where nothing was
        observed. Observations count whatever their clock: those later than `clock` count as new.
        """
        return typical_seconds(self.world, self.passes, clock)

    def blocked(self, clock: float) -> NDArray[np.float64]:
        """Probability (n_states, 4) that each move is refused at `clock`; 1 where the map has no move.

        All moves into one cell share it. A refusal raises it, a pass lowers it, and age brings it back to the
        share of refusals at this hour.
        """
        return blocked_probability(self.world, self.passes, clock)

    def costs(self, clock: float) -> MoveCosts:
        """The costs of all moves at `clock`."""
        return MoveCosts(self.world, self.seconds(clock), self.blocked(clock))

    @property
    def driven(self) -> NDArray[np.bool_]:
        """(n_states,) places from which or into which a robot has moved."""
        moves, driven = self.passes.move[self.passes.passes > 0], np.zeros(self.world.n_states, bool)
        driven[moves // records.N_ACTIONS] = driven[self.world.neighbour.ravel()[moves]] = True
        return driven

    def shut_off(self, closed: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(n_states,) places beside `closed` ones where no robot has been since one was refused there."""
        known, neighbour = self.passes, self.world.neighbour.ravel()
        refused, passed = np.full((2, self.world.n_states), -1)
        rows = known.where(known.refusals > 0)
        np.maximum.at(refused, neighbour[rows.move], rows.minute)
        rows = known.where(known.passes > 0)
        for places in (rows.move // records.N_ACTIONS, neighbour[rows.move]):
            np.maximum.at(passed, places, rows.minute)
        grid, cells = np.full(self.world.shape, -1), tuple(self.world.cells.T)
        grid[cells] = np.where(closed, refused, -1)
        return (maximum_filter(grid, 3, mode="constant", cval=-1)[cells] > passed) & ~closed

    @property
    def newest(self) -> float:
        """Seconds since 1970 of the newest observation by the robot's clock; 0 if there is none."""
        return 60.0 * self.passes.minute.max(initial=0)


def _remembered(world: GridWorld, grid: BuildingGrid, memory: Memory) -> Record | None:
    return memory.recall(records.KIND, records.key_of(world, grid), records.VERSION)
