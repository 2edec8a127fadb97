"""What the moves of a building cost, as arrays, for the exports to other programs."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.travel.travel import Travel
from lifelore.domains.grids.grid_world import GridWorld


@dataclass(frozen=True, eq=False)
class MoveCosts:
    """Costs of the moves of a building at one time.

    world : the building
    seconds : (n_states, 4) expected seconds of each move
    blocked : (n_states, 4) probability that the move is refused
    cost : (n_states, 4) seconds to plan with, the price of refusals included; inf where the map has no move
    """

    world: GridWorld
    seconds: NDArray[np.float64]
    blocked: NDArray[np.float64]
    cost: NDArray[np.float64]

    @classmethod
    def latest(cls, travel: Travel) -> Self:
        """The costs at the newest observation in memory, or anywhen if there is none."""
        clock = 60.0 * travel.passes.minute.max(initial=0)
        return cls(travel.world, travel.seconds(clock), travel.blocked(clock), travel.cost(clock))

    def at_places(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n_states,) mean of `values` (n_states, 4) over the moves out of and into a place; NaN without moves."""
        tail, action = np.nonzero(self.world.neighbour >= 0)
        head, value, n = self.world.neighbour[tail, action], values[tail, action], self.world.n_states
        total = np.bincount(tail, value, n) + np.bincount(head, value, n)
        moves = np.bincount(tail, minlength=n) + np.bincount(head, minlength=n)
        return np.divide(total, moves, out=np.full(n, np.nan), where=moves > 0)

    def closed(self) -> NDArray[np.bool_]:
        """(n_states,) places into which some move is more likely refused than not."""
        tail, action = np.nonzero((self.world.neighbour >= 0) & (self.blocked > 0.5))
        closed = np.zeros(self.world.n_states, bool)
        closed[self.world.neighbour[tail, action]] = True
        return closed
