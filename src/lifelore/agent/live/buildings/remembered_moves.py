"""The graph of the moves that memory holds about a building, compared with the building's map.

Nodes are cells by number (`cells_of`), also cells that the map no longer has, so that a way through a
door that was closed since can be reported. A robot can drive back the way it came: a remembered move counts in
both directions, unless memory holds that the move back was refused or led elsewhere.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.agent.live import transitions
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.driven.route import chain_to
from lifelore.core.errors import NotFoundError
from lifelore.domains.grids.cell_numbers import COLUMN_BITS
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.memory import Memory

_OPPOSITE = np.array([1, 0, 3, 2])
"""The action that leads back, for each action in the order of `MOVES`."""


@dataclass(frozen=True, eq=False)
class RememberedMoves:
    """Moves between different cells.

    world : the building
    cells : (n,) numbers of the cells, ascending
    tail, head : (n_moves,) indices into `cells`
    true : (n_moves,) whether the map has the move
    """

    world: GridWorld
    cells: NDArray[np.int64]
    tail: NDArray[np.int64]
    head: NDArray[np.int64]
    true: NDArray[np.bool_]

    @classmethod
    def recalled(cls, place: Place, memory: Memory) -> "RememberedMoves":
        """The moves in memory about a building or an earlier version of it.

        Raises
        ------
        NotFoundError
            Memory holds no transitions of this building.
        """
        world, corner = place.world, place.grid.corner
        record = place.earlier.record if place.earlier else None
        if record is None or record.key != world.fingerprint:
            record = memory.recall(transitions.KIND, world.fingerprint, transitions.VERSION) or record
        if record is None:
            settings = ", ".join(f"{name} {value:g}" for name, value in sorted(world.about.items()))
            raise NotFoundError(
                f"memory {memory.location} knows no moves of this building with {settings}; live there first "
                "(lifelore live --map), or give the options with which the robot lived there"
            )
        width = world.neighbour.shape[1] + 1
        source, column = record.slots // width, record.slots % width
        moved = (column < width - 1) & (record.values >= 0) & (record.values != source)
        source, column, target = source[moved], column[moved], record.values[moved]
        back = _OPPOSITE[column]
        slots = np.append(record.slots, -1)
        behind = np.searchsorted(record.slots, target * width + back)
        untold = (slots[behind] != target * width + back) | (np.append(record.values, -1)[behind] < 0)
        source, target = np.r_[source, target[untold]], np.r_[target, source[untold]]
        column = np.r_[column, back[untold]]
        source, target = (transitions.cells_from(record, cells, corner) for cells in (source, target))
        cells, ends = np.unique(np.concatenate([source, target]), return_inverse=True)
        states = transitions.states_in(world, np.concatenate([source, target])).reshape(2, -1)
        there = (states >= 0).all(axis=0)
        true = there & (world.neighbour[states[0], column] == states[1])
        tail, head = ends.reshape(2, -1)
        return cls(world, cells, tail, head, true)

    @cached_property
    def states(self) -> NDArray[np.int64]:
        """(n,) state in each cell, -1 where the map has none."""
        return transitions.states_in(self.world, self.cells)

    def reached(self, start: int, true_only: bool = True) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """Number of moves from cell index `start` to each cell, inf if none lead there; and the cell before it."""
        used = self.true if true_only else np.ones_like(self.true)
        edges = np.ones(int(used.sum())), (self.tail[used], self.head[used])
        graph = sparse.csr_array(edges, shape=(len(self.cells),) * 2)
        return csgraph.dijkstra(graph, indices=start, unweighted=True, return_predecessors=True)

    def chain(self, start: int, goal: int, true_only: bool = True) -> list[int]:
        """Cell indices of a shortest way, `start` first; empty if no way is known."""
        return chain_to(goal, start, self.reached(start, true_only)[1])

    def contradicted(self, chain: list[int]) -> NDArray[np.float64]:
        """Points (n, 2) in metres, halfway on the moves of a chain that the map does not have."""
        true = set(zip(self.tail[self.true].tolist(), self.head[self.true].tolist(), strict=True))
        wrong = [move for move in pairwise(chain) if move not in true]
        return self.points(np.array(wrong, int).reshape(-1, 2).ravel()).reshape(-1, 2, 2).mean(axis=1)

    @property
    def open(self) -> NDArray[np.bool_]:
        """(n_states, 4) bool, the moves of the map that memory holds."""
        tail, head = self.states[self.tail[self.true]], self.states[self.head[self.true]]
        joins = self.world.neighbour[tail] == head[:, None]
        known = np.zeros(self.world.neighbour.shape, np.bool_)
        np.logical_or.at(known, tail, joins)
        return known

    def points(self, index: NDArray[np.int64]) -> NDArray[np.float64]:
        """Centres (n, 2) in metres of the map's frame, of cells by index."""
        frame, number = self.world.frame, self.cells[index]
        from_bottom, column = number >> COLUMN_BITS, number & ((1 << COLUMN_BITS) - 1)
        return frame.metres(column + 0.5, from_bottom + 0.5)
