"""What the moves of a building cost at one time: seconds, risk of a refusal, and both in seconds."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.grids.grid_world import GridWorld

DETOUR = 60.0
"""Seconds that a refused move costs: turning round, and another way."""


@dataclass(frozen=True, eq=False)
class MoveCosts:
    """Costs of the moves of a building at one time.

    world : the building
    seconds : (n_states, 4) typical seconds of each move
    blocked : (n_states, 4) probability that the move is refused
    """

    world: GridWorld
    seconds: NDArray[np.float64]
    blocked: NDArray[np.float64]

    @cached_property
    def cost(self) -> NDArray[np.float64]:
        """Seconds (n_states, 4) to plan with: typical seconds + probability of refusal · `DETOUR`.

        Infinite where the map has no move.
        """
        return np.where(self.world.neighbour >= 0, self.seconds + DETOUR * self.blocked, np.inf)

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
