"""What the moves of a building cost, as arrays, for the exports to other programs."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.grids.grid_world import GridWorld

if TYPE_CHECKING:
    from lifelore.agent.travel.travel import Travel


@dataclass(frozen=True, eq=False)
class MoveCosts:
    """Costs of the moves of a building at one time.

    world : the building
    seconds : (n_states, 4) expected seconds of each move
    blocked : (n_states, 4) probability that the move is refused
    cost : (n_states, 4) seconds to plan with, the price of refusals included; inf where the map has no move
    free_seconds : seconds of a move that nothing hinders
    """

    world: GridWorld
    seconds: NDArray[np.float64]
    blocked: NDArray[np.float64]
    cost: NDArray[np.float64]
    free_seconds: float

    @classmethod
    def at(cls, travel: "Travel", clock: float) -> Self:
        """The costs that memory expects at `clock`, seconds since 1970."""
        seconds, blocked = travel.seconds(clock), travel.blocked(clock)
        return cls(travel.world, seconds, blocked, travel.cost(clock), travel.nominal)

    def mean_at_places(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n_states,) mean of `values` (n_states, 4) over the moves out of a place and into it; NaN without moves."""
        tail, action = np.nonzero(self.world.neighbour >= 0)
        head, value, n = self.world.neighbour[tail, action], values[tail, action], self.world.n_states
        total = np.bincount(tail, value, n) + np.bincount(head, value, n)
        moves = np.bincount(tail, minlength=n) + np.bincount(head, minlength=n)
        return np.divide(total, moves, out=np.full(n, np.nan), where=moves > 0)
