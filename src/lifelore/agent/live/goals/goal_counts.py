"""Where goals were found before: the belief over recurring destinations, and the order in which to try them.

The belief is over types of tasks: the goal is in one of the remembered destinations, or in a place where none was
found yet. A policy for each remembered destination goes there, one more tours all places. The probability of a new
place is that of Good and Turing: the share of goals that were found once.

A record of kind "goal_counts" adds the goals found in each cell, counted in the grid of the building's first map.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.building_record import joined_buildings
from lifelore.agent.live import transitions
from lifelore.agent.travel.passes import key_of
from lifelore.core.planning.destination_order import MOST_EXACT, by_exact_search, by_rate
from lifelore.core.protocols import Record
from lifelore.domains.grids.cell_numbers import COLUMN_BITS, BuildingGrid, cells_in_building, states_in_building
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.memory import Memory

KIND, VERSION = "goal_counts", 1
MOST_TRIED = 64
"""Remembered destinations, the most frequent first, among which an agent chooses."""


@dataclass
class GoalCounts:
    """How often the goal was found in each state of a world.

    count : (n_states,) int64
    """

    world: GridWorld
    grid: BuildingGrid
    count: NDArray[np.int64]

    @classmethod
    def recalled(cls, world: GridWorld, grid: BuildingGrid, memory: Memory) -> "GoalCounts":
        """The counts that memory holds of this building; cells that the map no longer has are left out."""
        counts = cls(world, grid, np.zeros(world.n_states, np.int64))
        for record in counts._remembered(grid, memory):
            counts._add(states_in_building(world, record.slots, grid.corner), record.values)
        for key, joined in joined_buildings(memory).items():
            if joined.home.key == grid.building:
                for record in counts._remembered(grid._replace(building=key), memory):
                    row, column = record.slots >> COLUMN_BITS, record.slots & (2**COLUMN_BITS - 1)
                    counts._add(joined.states(world, grid, row, column), record.values)
        return counts

    def _remembered(self, grid: BuildingGrid, memory: Memory) -> list[Record]:
        """The counts of a building; earlier versions stored them without the size of cells."""
        found = memory.recall(KIND, key_of(self.world, grid), VERSION)
        earlier = None if grid.building is None else memory.recall(KIND, grid.building, VERSION)
        if earlier is not None and not self._are_own_cells(earlier, memory):
            earlier = None
        return [record for record in (found, earlier) if record is not None]

    def _are_own_cells(self, goals: Record, memory: Memory) -> bool:
        """Whether goals lie in cells of this size: its moves alone are known, or they alone entered all goals."""
        own, fitting = self.world.frame.cell, {}
        for key, version, about in memory.keys(transitions.KIND):
            if about.get("building") == goals.key and (moves := memory.recall(transitions.KIND, key, version)):
                cell = about.get("settings", {}).get("cell", own)
                fitting[cell] = fitting.get(cell, False) or transitions.has_entered(moves, goals.slots)
        return set(fitting) <= {own} or [cell for cell, fits in fitting.items() if fits] == [own]

    def _add(self, states: NDArray[np.int64], count: NDArray[np.int64]) -> None:
        np.add.at(self.count, states[states >= 0], count[states >= 0])

    def copy(self) -> "GoalCounts":
        """An independent copy for another agent."""
        return GoalCounts(self.world, self.grid, self.count.copy())

    def found(self, goal: int) -> Record:
        """Count a goal that was found; returns the contribution to memory, empty outside the first map's grid."""
        self.count[goal] += 1
        cell = cells_in_building(self.world, self.grid.corner)[[goal]]
        slots = cell[cell >= 0]
        about = {"world": self.world.name, "building": self.grid.building}
        return Record(KIND, key_of(self.world, self.grid), VERSION, "add", slots, np.ones_like(slots), about)

    def belief(self) -> tuple[NDArray[np.int64], NDArray[np.float64], float]:
        """Remembered destinations, the probability of each, and that of a place where no goal was found yet.

        The probabilities sum to 1 with at most `MOST_TRIED` destinations.
        """
        total, once = int(self.count.sum()), int((self.count == 1).sum())
        new = (once + 0.5) / (total + 1)
        places = np.argsort(-self.count, kind="stable")[: min(MOST_TRIED, int((self.count > 0).sum()))]
        return places, (1 - new) * self.count[places] / max(total, 1), new

    def order(self, steps: NDArray[np.float64], places: NDArray[np.int64], tour: float) -> NDArray[np.int64]:
        """The destinations to try before a tour of all places, in order: exact up to `MOST_EXACT` of them.

        Parameters
        ----------
        steps : (n + 1, n) float
            Steps between `places`, the last row from the start; infinite where no way is known.
        places : (n,) int
            Destinations of `belief` that were not visited in this task.
        tour : float
            Steps of the tour.
        """
        known, chance, new = self.belief()
        among = np.array([int(np.flatnonzero(known == place)[0]) for place in places.tolist()], int)
        rule = by_exact_search if len(places) <= MOST_EXACT else by_rate
        return places[rule(steps, chance[among], new, tour)]
