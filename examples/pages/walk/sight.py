"""Computes which places of a building are in sight of each other, up to a distance.

A place is seen at its anchor, the pixel of its piece that is farthest from obstacles. The straight line between
two anchors must touch no solid pixel: obstacles and unknown space at the map's resolution, not grown by the
robot's radius. A line through a corner touches the pixels on both sides of it.
"""

import numpy as np
from scipy import sparse

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.grids.grid_world import GridWorld

_BLOCK = 4_000_000  # candidate pairs that are tested at once


def visible_places(floor: Floor, world: GridWorld, reach: float) -> sparse.csr_array:
    """The places in sight of each place.

    Parameters
    ----------
    floor : Floor
        The floor of `world`.
    world : GridWorld
    reach : float
        Largest distance between two anchors in metres, > 0.

    Returns
    -------
    scipy.sparse.csr_array
        (n_states, n_states) bool, True where a place is in sight; symmetric, with sorted indices. A place is in
        sight of itself and of all places that a move leads to, whatever the range.
    """
    n, anchors = world.n_states, np.ascontiguousarray(floor.anchors)
    pixels = reach / floor.occupancy.resolution
    # Anchors lie anywhere in their cells, so two of them may be nearer than their cells by almost one cell.
    window = int(np.ceil(reach / world.frame.cell)) + 1
    block = max(1, _BLOCK // (2 * window + 1) ** 2)
    buffer = np.empty((min(n, block) * (2 * window + 1) ** 2, 2), np.int32)
    found = []
    for first in range(0, n, block):
        last = min(first + block, n)
        count = _in_sight(first, last, anchors, world.cells, world.state_of, floor.solid, pixels, window, buffer)
        found.append(buffer[:count].copy())
    near, move = np.nonzero(world.neighbour >= 0)
    itself = np.arange(n)
    a, b = np.concatenate(found).T
    row, column = (
        np.concatenate(ends)
        for ends in ((a, b, near, itself), (b, a, world.neighbour[near, move].astype(np.int32), itself))
    )
    return sparse.csr_array((np.ones(len(row), bool), (row, column)), shape=(n, n))


@kernel
def _in_sight(first, last, anchors, cells, state_of, solid, reach, window, pairs):
    """Write the pairs (s, t), s < t, of states in sight of each other for s in [first, last); returns how many."""
    count = 0
    rows, columns = state_of.shape
    for s in range(first, last):
        for row in range(max(0, cells[s, 0] - window), min(rows, cells[s, 0] + window + 1)):
            for column in range(max(0, cells[s, 1] - window), min(columns, cells[s, 1] + window + 1)):
                t = state_of[row, column]
                if t > s:
                    down, right = anchors[t, 0] - anchors[s, 0], anchors[t, 1] - anchors[s, 1]
                    if down * down + right * right <= reach * reach and is_clear(
                        anchors[s, 0], anchors[s, 1], anchors[t, 0], anchors[t, 1], solid
                    ):
                        pairs[count, 0] = s
                        pairs[count, 1] = t
                        count += 1
    return count


@inlined
def is_clear(row, column, last_row, last_column, solid):
    """Whether the line between the centres of two pixels touches no solid pixel after the first."""
    down, right = abs(last_row - row), abs(last_column - column)
    one_down = 1 if last_row > row else -1
    one_right = 1 if last_column > column else -1
    crossed_rows, crossed_columns = 0, 0
    clear = True
    while clear and (crossed_rows < down or crossed_columns < right):
        # Which border the line crosses next, in whole numbers: (2 i + 1) / (2 down) against (2 j + 1) / (2 right).
        order = (1 + 2 * crossed_rows) * right - (1 + 2 * crossed_columns) * down
        if order == 0:
            clear = not (solid[row + one_down, column] or solid[row, column + one_right])
        if order <= 0:
            row += one_down
            crossed_rows += 1
        if order >= 0:
            column += one_right
            crossed_columns += 1
        clear = clear and not solid[row, column]
    return clear
