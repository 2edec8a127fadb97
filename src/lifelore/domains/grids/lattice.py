"""The lattice: a walled square in which every second row and column is passable.

Thesis: §3.4.1, Figure 3.2.
"""

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.grids.grid_world import GridWorld

MAX_SIZE = 1001


def lattice(
    size: int = 23, discount: float = 0.95, goal_reward: float = 100.0, wall_reward: float = -10.0
) -> GridWorld:
    """The thesis's lattice; 341 states at size 23.

    Parameters
    ----------
    size : int
        Cells a side, the wall around counted; odd, 5 to `MAX_SIZE`.
    discount, goal_reward, wall_reward : float
        As in `GridWorld`; the defaults are the thesis's.

    Raises
    ------
    InputError
        `size` breaks its rule.

    Examples
    --------
    >>> lattice().n_states, lattice(7).n_states
    (341, 21)
    """
    if size % 2 == 0 or not 5 <= size <= MAX_SIZE:
        raise InputError(f"size of a lattice must be odd and lie in [5, {MAX_SIZE}], got {size}")
    odd = np.arange(size) % 2 == 1
    free = np.logical_or.outer(odd, odd)
    free[[0, -1]] = free[:, [0, -1]] = False
    return GridWorld.from_free(
        "lattice", free, discount=discount, goal_reward=goal_reward, wall_reward=wall_reward
    )
