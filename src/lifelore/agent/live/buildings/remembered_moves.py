"""The moves that memory holds about a building, compared with the building's map."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.agent.live import transitions
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.driven.route import chain_to
from lifelore.core.errors import NotFoundError
from lifelore.core.protocols import Record
from lifelore.domains.grids.cell_numbers import COLUMN_BITS
from lifelore.memory import Memory

_MORE = 1e-6
"""What a contradicted move costs beyond a move of the map: of equally short ways, that of the map is taken."""


def remembered_record(place: Place, memory: Memory) -> Record:
    """What memory holds about the moves of a building, or of an earlier version of it.

    Raises
    ------
    NotFoundError
        Memory holds nothing of this building.
    """
    world, record = place.world, place.earlier.record if place.earlier else None
    if record is None or record.key != world.fingerprint:
        record = memory.recall(transitions.KIND, world.fingerprint, transitions.VERSION) or record
    if record is None:
        settings = ", ".join(f"{name} {value:g}" for name, value in sorted(world.about.items()))
        raise NotFoundError(
            f"memory {memory.location} knows no moves of this building with {settings}; live there first "
            "(lifelore live --map), or give the options with which the robot lived there"
        )
    return record


def contradicted_moves(place: Place, record: Record, start: int, goal: int) -> NDArray[np.float64]:
    """Points (n, 2) in metres, halfway on remembered moves that the map lacks and that would shorten the way.

    `start` and `goal` are states. Cells that the map no longer has count too, so that the points show a door that
    was closed since.
    """
    world, width = place.world, place.world.neighbour.shape[1] + 1
    source, column = record.slots // width, record.slots % width
    moved = (column < width - 1) & (record.values >= 0) & (record.values != source)
    cells = np.column_stack([source, record.values])[moved]
    cells = transitions.cells_from(record, cells, place.grid.corner)
    states = transitions.states_in(world, cells)
    on_map = (states >= 0).all(axis=1) & (world.neighbour[states[:, 0], column[moved]] == states[:, 1])
    lacking = ~on_map & (cells >= 0).all(axis=1)
    if not lacking.any():
        return np.empty((0, 2))
    cells, states = cells[lacking], states[lacking]
    # Cells that the map lacks become nodes behind the states.
    gone, number = np.unique(cells[states < 0], return_inverse=True)
    states[states < 0] = world.n_states + number
    tail, action = np.nonzero(world.neighbour >= 0)
    both_ways = np.unique(np.vstack([states, states[:, ::-1]]), axis=0)
    edges = np.vstack([both_ways, np.column_stack([tail, world.neighbour[tail, action]])])
    weight = np.repeat([1 + _MORE, 1.0], [len(both_ways), len(tail)])
    graph = sparse.csr_array((weight, edges.T), shape=(world.n_states + len(gone),) * 2)
    chain = chain_to(goal, start, csgraph.dijkstra(graph, indices=start, return_predecessors=True)[1])
    lost = set(map(tuple, both_ways.tolist()))
    used = np.array([move for move in pairwise(chain) if move in lost], np.int64).reshape(-1, 2)
    used_cells = np.r_[transitions.cells_of(world), gone][used]
    row, column = used_cells >> COLUMN_BITS, used_cells & ((1 << COLUMN_BITS) - 1)
    return world.frame.metres(column.mean(axis=1) + 0.5, row.mean(axis=1) + 0.5)
