"""MiniGrid for learners and priors: the view as an array, the open directions, and the best moves of a layout.

The functions read the environments' own arrays; only making an environment needs MiniGrid (extra ``envs``).
Layouts may have walls, lava and goals; doors, keys and boxes count as blocked.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from gymnasium.spaces import Box, Discrete
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.core.errors import InputError

SIDE = 7
UNSEEN, FREE, BLOCKED, GOAL = range(4)
LEFT, RIGHT, FORWARD = range(3)
N_MOVES = 3
"""The first of MiniGrid's seven actions; the others handle objects, and layouts of walls have none."""

_KIND = np.full(256, BLOCKED)
_KIND[[0, 1, 3, 8]] = UNSEEN, FREE, FREE, GOAL  # MiniGrid's numbers for unseen, empty, floor and goal
_ONE_HOT = np.eye(4, dtype=np.float32)
_BESIDE = np.ravel_multi_index(([2, 3, 4], [6, 5, 6]), (SIDE, SIDE))
"""Cells to the left, in front and to the right of the robot, which stands at (3, 6) of its view facing (3, 5)."""
_BITS = np.array([1, 2, 4])
_WEIGHTS = np.zeros(SIDE * SIDE * 4 + 4, np.float32)
_WEIGHTS[4 * _BESIDE + FREE] = _WEIGHTS[4 * _BESIDE + GOAL] = _BITS
_DIRECTIONS = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])


class SymbolicView(gymnasium.ObservationWrapper):
    """A MiniGrid environment with the view as a flat array, and only the three moves as actions.

    Observations are (200,) float32 of zeros and ones: for each of 7 × 7 cells unseen, free, blocked or goal, then
    the robot's direction, one of four.

    Examples
    --------
    >>> import minigrid
    >>> env = SymbolicView(gymnasium.make("MiniGrid-Empty-5x5-v0"))
    >>> observation, info = env.reset(seed=0)
    >>> observation.shape
    (200,)
    """

    def __init__(self, env: gymnasium.Env) -> None:
        super().__init__(env)
        self.observation_space = Box(0.0, 1.0, (SIDE * SIDE * 4 + 4,), np.float32)
        self.action_space = Discrete(N_MOVES)

    def observation(self, observation: Mapping[str, Any]) -> NDArray[np.float32]:
        """MiniGrid's observation as an array."""
        cells = _ONE_HOT[_KIND[observation["image"][..., 0]]]
        return np.concatenate((cells.ravel(), _ONE_HOT[observation["direction"]]))


def open_directions(observations: NDArray[np.float32]) -> NDArray[np.int64]:
    """Codes 0 to 7 of the directions that are free or the goal (left 1, front 2, right 4), (n,) from (n, 200).

    Examples
    --------
    >>> import minigrid
    >>> env = SymbolicView(gymnasium.make("MiniGrid-Empty-5x5-v0"))
    >>> observation, info = env.reset(seed=0)
    >>> open_directions(observation[None]).tolist()
    [6]
    """
    return observations.dot(_WEIGHTS).astype(np.int64)


class SolvedLayout(NamedTuple):
    """Best moves of each pose (cell and direction) from which the goal can be reached.

    `open_directions` (n,) int64 from the function of this name; `best` (n, 3) bool, every tied-best move; `steps`
    (n,) to the goal; `passed` (n,) bool, whether a shortest path from the robot's pose leads through the pose.
    """

    open_directions: NDArray[np.int64]
    best: NDArray[np.bool_]
    steps: NDArray[np.int64]
    passed: NDArray[np.bool_]


def solved_layout(env: gymnasium.Env) -> SolvedLayout:
    """The exact solution of the layout after the environment's last reset, without the poses in the goal.

    Raises
    ------
    InputError
        The environment is not from MiniGrid, or its layout has no goal.

    Examples
    --------
    >>> import minigrid
    >>> env = gymnasium.make("MiniGrid-Empty-5x5-v0")
    >>> observation, info = env.reset(seed=0)
    >>> solved_layout(env).best.shape
    (32, 3)
    """
    grid = getattr(env.unwrapped, "grid", None)
    if grid is None or not hasattr(grid, "encode"):
        raise InputError(f"env must be a MiniGrid environment that was reset, got {type(env.unwrapped).__name__}")
    kind = np.pad(_KIND[grid.encode()[..., 0]], 1, constant_values=BLOCKED)
    if not (kind == GOAL).any():
        raise InputError("env must have a goal in its layout, got none")
    cells = np.argwhere((kind == FREE) | (kind == GOAL))
    number = np.full(kind.shape, -1)
    number[tuple(cells.T)] = np.arange(len(cells))
    # Pose 4 · cell + direction.
    ahead = number[tuple((cells[:, None] + _DIRECTIONS).transpose(2, 0, 1))]
    cell, direction = np.indices((len(cells), 4)).reshape(2, -1)
    forward = 4 * np.where(ahead.ravel() >= 0, ahead.ravel(), cell) + direction
    after = np.column_stack([4 * cell + (direction - 1) % 4, 4 * cell + (direction + 1) % 4, forward])
    moves = sparse.csr_array((np.ones(after.size), after.ravel(), np.arange(0, after.size + 1, N_MOVES)))
    ends = np.flatnonzero(kind[tuple(cells[cell].T)] == GOAL)
    steps = np.asarray(csgraph.dijkstra(moves.T, indices=ends, unweighted=True, min_only=True))
    x, y = env.unwrapped.agent_pos  # pyright: ignore[reportAttributeAccessIssue]
    stands = number[x + 1, y + 1]
    here = 4 * stands + env.unwrapped.agent_dir  # pyright: ignore[reportAttributeAccessIssue]
    on_way = np.asarray(csgraph.dijkstra(moves, indices=here, unweighted=True)) + steps == steps[here]
    beside = ahead[cell[:, None], (direction[:, None] + np.arange(-1, 2)) % 4] >= 0
    counted = np.isfinite(steps) & (steps > 0)
    best = steps[after[counted]] + 1 == steps[counted, None]
    passed = on_way[counted] & (stands >= 0) & np.isfinite(steps[here])
    return SolvedLayout(
        np.where(beside, _BITS, 0).sum(axis=1)[counted], best, steps[counted].astype(np.int64), passed
    )
