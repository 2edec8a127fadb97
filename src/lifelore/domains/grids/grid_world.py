"""Four-move grid worlds: cells, what the agent perceives in them, and the goal tasks they pose.

One definition serves every grid of ours: the thesis's lattice and noise mazes and real buildings differ
only in which cells exist and which moves join them.
"""

import hashlib
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.jit import inlined
from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, NOTHING, TERMINAL, Domain, Task

MOVES = np.array([(-1, 0), (1, 0), (0, 1), (0, -1)])
"""North, South, East, West as (row, column) steps; the order of the actions."""
MOVE_NAMES = ("north", "south", "east", "west")
DIAGONALS = np.array([(-1, 1), (-1, -1), (1, 1), (1, -1)])
PERCEPT = "grid-8: bits 0-3 N,S,E,W move passable; bits 4-7 NE,NW,SE,SW cell occupied"
MOVE_BITS = 0b1111
"""The part of a percept that tells which moves are passable."""


@inlined
def step(params, s, a, u):
    """One move: into a wall (stay, `wall_reward`), into the goal (end, `goal_reward`), or on (0)."""
    neighbour, goal, goal_reward, wall_reward = params
    target = neighbour[s, a]
    if target < 0:
        return s, wall_reward, COLLISION
    if target == goal:
        return target, goal_reward, TERMINAL
    return target, 0.0, NOTHING


def tabulate(params, midpoints):
    """`step` for every state and action at once; there is nothing to compile for."""
    neighbour, goal, goal_reward, wall_reward = params
    wall, home = neighbour < 0, neighbour == goal
    here = np.arange(len(neighbour), dtype=np.int32)[:, None]
    tables = (
        np.where(wall, here, neighbour).astype(np.int32),
        np.where(wall, wall_reward, np.where(home, goal_reward, 0.0)),
        np.where(wall, COLLISION, np.where(home, TERMINAL, NOTHING)).astype(np.uint8),
    )
    return tuple(np.repeat(table[..., None], midpoints.size, axis=2) for table in tables)


@dataclass(frozen=True)
class Frame:
    """Pose of a grid in the world, from cells (row, column) to metres.

    Row 0 is the top of the picture; `origin` is the world position (x, y, yaw) of the lower left corner
    of the lower left cell, as ROS has it; `cell` is the side of a cell in metres.

    Examples
    --------
    >>> Frame(cell=0.5, origin=(1.0, 2.0, 0.0)).metres([0, 4], [0, 2]).tolist()
    [[1.0, 2.0], [3.0, 3.0]]
    """

    cell: float = 1.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def metres(self, columns: ArrayLike, rows: ArrayLike) -> NDArray[np.float64]:
        """World positions in metres, (n, 2) x and y, of points in cells; `rows` count upwards from the corner."""
        x0, y0, yaw = self.origin
        x, y = np.asarray(columns) * self.cell, np.asarray(rows) * self.cell
        cos, sin = np.cos(yaw), np.sin(yaw)
        return np.column_stack([x0 + cos * x - sin * y, y0 + sin * x + cos * y])

    def cells(self, points: ArrayLike) -> NDArray[np.float64]:
        """Columns and rows (2, n) of points (n, 2) in metres; the inverse of `metres`."""
        x0, y0, yaw = self.origin
        dx, dy = (np.asarray(points, float).reshape(-1, 2) - (x0, y0)).T / self.cell
        return np.array([np.cos(yaw) * dx + np.sin(yaw) * dy, np.cos(yaw) * dy - np.sin(yaw) * dx])


@dataclass(frozen=True, eq=False)
class GridWorld:
    """Cells of a grid and the moves between them.

    Parameters
    ----------
    name : str
        Kind of world: ``"building"``, ``"lattice"``, ``"noise"`` …
    shape : (rows, columns)
    cells : (n_states, 2) int
        Row and column of each state; a state's number is its place in this list.
    neighbour : (n_states, 4) int32
        The state that each move leads to, in the order of `MOVES`; -1 where the move is refused.
    discount, goal_reward, wall_reward : float
        γ in [0, 1); thesis §3.4.1: 0.95, 100, -10.
    frame : Frame
        Where the grid lies in the world.
    about : dict
        What else must agree for two grids to be the same world (robot radius, say); part of
        `fingerprint`.

    Examples
    --------
    >>> world = GridWorld.from_free("room", np.ones((2, 3), bool))
    >>> world.n_states, world.task(5).tables().n_actions
    (6, 4)
    """

    name: str
    shape: tuple[int, int]
    cells: NDArray[np.int32]
    neighbour: NDArray[np.int32]
    discount: float = 0.95
    goal_reward: float = 100.0
    wall_reward: float = -10.0
    frame: Frame = field(default_factory=Frame)
    about: dict = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.n_states < 2:
            raise InputError(f"a grid world needs at least 2 cells, got {self.n_states}")
        if not 0.0 <= self.discount < 1.0:
            raise InputError(f"discount must lie in [0, 1), got {self.discount}")
        for label in ("goal_reward", "wall_reward"):
            if not np.isfinite(getattr(self, label)):
                raise InputError(f"{label} must be a finite number, got {getattr(self, label)}")

    @classmethod
    def from_free(cls, name: str, free: NDArray[np.bool_], **settings) -> "GridWorld":
        """The world of the free cells of a picture; moves join every two free cells side by side.

        Parameters
        ----------
        name : str
        free : (rows, columns) bool
            Row 0 is the top; what lies outside the picture is wall.
        **settings
            Further fields of `GridWorld`: discount, rewards, frame, about.
        """
        cells = np.argwhere(free)
        state_of = np.full((free.shape[0] + 2, free.shape[1] + 2), -1, np.int32)
        state_of[1:-1, 1:-1][free] = np.arange(len(cells))
        beside = cells[:, None, :] + 1 + MOVES
        neighbour = np.ascontiguousarray(state_of[beside[..., 0], beside[..., 1]])
        return cls(name, free.shape, np.ascontiguousarray(cells, dtype=np.int32), neighbour, **settings)

    @property
    def n_states(self) -> int:
        """Number of free cells."""
        return len(self.cells)

    @cached_property
    def domain(self) -> Domain:
        """The grid as a `Domain`; deterministic."""
        return Domain(self.name, self.n_states, len(MOVES), step, self.discount, tabulate=tabulate)

    def task(self, goal: int, starts: NDArray[np.int32] | None = None) -> Task:
        """Reach state `goal`; episodes start in `starts` (default: any other state)."""
        if not 0 <= goal < self.n_states:
            raise InputError(f"goal must be a state in [0, {self.n_states}), got {goal}")
        if starts is None:
            starts = np.delete(np.arange(self.n_states, dtype=np.int32), goal)
        params = (self.neighbour, int(goal), float(self.goal_reward), float(self.wall_reward))
        return Task(self.domain, params, starts, goal)

    @cached_property
    def state_of(self) -> NDArray[np.int32]:
        """(rows, columns) int32: the state in each cell, -1 where there is none."""
        lookup = np.full(self.shape, -1, np.int32)
        lookup[tuple(self.cells.T)] = np.arange(self.n_states)
        return lookup

    @cached_property
    def percepts(self) -> NDArray[np.int64]:
        """(n_states,) int64 codes of `PERCEPT`: which moves pass, which diagonal cells are occupied."""
        around = np.pad(self.state_of, 1, constant_values=-1)
        code = ((self.neighbour >= 0) << np.arange(4)).sum(axis=1)
        for bit, (d_row, d_column) in enumerate(DIAGONALS, start=4):
            occupied = around[self.cells[:, 0] + 1 + d_row, self.cells[:, 1] + 1 + d_column] < 0
            code = code + (occupied.astype(np.int64) << bit)
        return code.astype(np.int64)

    @cached_property
    def fingerprint(self) -> str:
        """Hash of grid, moves, frame, actions and `about`: equal only for the same world."""
        digest = hashlib.sha256()
        for array in (np.asarray(self.shape), self.cells, self.neighbour):
            digest.update(np.ascontiguousarray(array, dtype=np.int64).tobytes())
        digest.update(repr((self.name, MOVE_NAMES, self.frame, sorted(self.about.items()))).encode())
        return digest.hexdigest()[:32]

    def positions(self, states: NDArray[np.int32]) -> NDArray[np.float64]:
        """World positions in metres, (n, 2) x and y, of the centres of the states' cells."""
        rows, columns = self.cells[states].T
        return self.frame.metres(columns + 0.5, self.shape[0] - rows - 0.5)

    @cached_property
    def move_vectors(self) -> NDArray[np.float64]:
        """Unit vectors (n_actions, 2) of the moves, x and y in the world."""
        return Frame(1.0, (0.0, 0.0, self.frame.origin[2])).metres(MOVES[:, 1], -MOVES[:, 0])

    def around(self, states: NDArray[Any]) -> NDArray[np.bool_]:
        """(n_states,) whether a state is one of `states`, given by number or as a mask, or touches one."""
        grid = np.zeros(np.add(self.shape, 2), np.bool_)
        for offset in np.ndindex(3, 3):
            grid[tuple((self.cells[states] + offset).T)] = True
        return grid[tuple((self.cells + 1).T)]

    def states_at(self, points: ArrayLike) -> NDArray[np.int32]:
        """The states (n,) int32 in whose cells `points` lie, (n, 2) x and y in metres; -1 where there is none."""
        column, row = np.floor(self.frame.cells(points))
        row = self.shape[0] - 1 - row
        inside = (row >= 0) & (row < self.shape[0]) & (column >= 0) & (column < self.shape[1])
        states = np.full(len(row), -1, np.int32)
        states[inside] = self.state_of[row[inside].astype(int), column[inside].astype(int)]
        return states
