"""Turns the poses of a run into moves of a building: made, refused, or contradicting the map.

Between two poses the robot is taken to have driven straight. A move between two cells that the map separates is
not learnt: a pose that is 10 cm off hops through a thin wall. A bump is learnt also where the map is free, because
the robot met an obstacle that the map lacks.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.learn_from.run_log import BUMP, Run
from lifelore.domains.grids.grid_world import GridWorld

FARTHEST = 2.0
"""Cells: the longest straight piece between two poses; over a longer one the way of the robot is not known."""
PER_CELL = 20
"""Points on a straight piece, for each cell of its length."""
AT_REST = 0.02
"""Metres that a robot has to move for its direction to be known."""


@dataclass
class TriedMoves:
    """Moves of a run in a building.

    states, actions, targets : lists of int
        The cell, the move, and the cell that it led to: the same cell after a bump. In order of time.
    outside : int
        Poses on no place of the building.
    gaps : int
        Pairs of poses that are too far apart.
    contradictions : int
        Moves between neighbouring cells that the map separates.
    new_obstacles : list of (state, action)
        Bumps where the map is free.
    undirected : int
        Bumps whose direction is not known.
    """

    states: list[int] = field(default_factory=list)
    actions: list[int] = field(default_factory=list)
    targets: list[int] = field(default_factory=list)
    outside: int = 0
    gaps: int = 0
    contradictions: int = 0
    new_obstacles: list[tuple[int, int]] = field(default_factory=list)
    undirected: int = 0

    def _add(self, state: int, action: int, target: int) -> None:
        self.states.append(state)
        self.actions.append(action)
        self.targets.append(target)


def tried_moves(world: GridWorld, run: Run) -> TriedMoves:
    """The moves that a robot tried in a run."""
    tried = TriedMoves()
    here = world.states_at(run.points)
    tried.outside = int((here < 0).sum())
    for i in range(len(here)):
        if i and _connected(world, run, here, i):
            _drive(world, run.points[i - 1], run.points[i], tried)
        elif i:
            tried.gaps += 1
        if run.outcome[i] == BUMP and here[i] >= 0:
            _bump(world, int(here[i]), _direction(run, i), tried)
    return tried


def _connected(world: GridWorld, run: Run, here: NDArray[np.int32], i: int) -> bool:
    near = np.hypot(*(run.points[i] - run.points[i - 1])) <= FARTHEST * world.frame.cell
    return bool(near and here[i] >= 0 and here[i - 1] >= 0)


def _drive(world: GridWorld, a: NDArray, b: NDArray, tried: TriedMoves) -> None:
    n = max(2, int(np.ceil(np.hypot(*(b - a)) / world.frame.cell * PER_CELL)) + 1)
    along = world.states_at(np.linspace(a, b, n))
    changes = np.flatnonzero(np.diff(along))
    for state, target in zip(along[changes].tolist(), along[changes + 1].tolist(), strict=True):
        if state < 0 or target < 0:
            continue
        action = np.flatnonzero(world.neighbour[state] == target)
        if len(action):
            tried._add(state, int(action[0]), target)
        elif np.abs(world.cells[state] - world.cells[target]).sum() == 1:
            tried.contradictions += 1


def _bump(world: GridWorld, state: int, direction: NDArray | None, tried: TriedMoves) -> None:
    if direction is None:
        tried.undirected += 1
        return
    action = int(np.argmax(world.move_vectors @ direction))
    if world.neighbour[state, action] >= 0:
        tried.new_obstacles.append((state, action))
    tried._add(state, action, state)


def _direction(run: Run, i: int) -> NDArray[np.float64] | None:
    """The direction in which the robot drove at pose `i`: its heading, or else where it came from."""
    if np.isfinite(run.heading[i]):
        return np.array([np.cos(run.heading[i]), np.sin(run.heading[i])])
    for j in range(i - 1, -1, -1):
        moved = run.points[i] - run.points[j]
        if np.hypot(*moved) >= AT_REST:
            return moved / np.hypot(*moved)
    return None
