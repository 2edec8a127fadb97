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
    kind = _KIND[grid.encode()[..., 0]]
    if not (kind == GOAL).any():
        raise InputError("env must have a goal in its layout, got none")
    passable = (kind == FREE) | (kind == GOAL)
    before = np.stack([_neighbour(passable, direction) for direction in range(4)], axis=-1)
    after = _distances_after_moves(passable, kind == GOAL)
    steps = after.min(axis=-1) + 1
    counted = (passable & (kind != GOAL))[..., None] & np.isfinite(steps)
    directions = np.stack([before[..., [(d - 1) % 4, d, (d + 1) % 4]] @ _BITS for d in range(4)], axis=-1)
    best = (after + 1 == steps[..., None]) & counted[..., None]
    here = (*env.unwrapped.agent_pos, env.unwrapped.agent_dir)  # pyright: ignore[reportAttributeAccessIssue]
    passed = _passed(best, here)
    return SolvedLayout(directions[counted], best[counted], steps[counted].astype(np.int64), passed[counted])


def _neighbour(cells: NDArray[Any], direction: int) -> NDArray[Any]:
    """Values of the next cell in a direction; the outer wall hides the values from the opposite side."""
    return np.roll(cells, tuple(-_DIRECTIONS[direction]), axis=(0, 1))


def _distances_after_moves(passable: NDArray[np.bool_], goal: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Steps to the goal after turning left, turning right and moving forward, (width, height, 4, 3)."""
    steps = np.where(goal, 0.0, np.inf)[..., None].repeat(4, axis=-1)
    while True:
        forward = np.stack(
            [np.where(_neighbour(passable, d), _neighbour(steps[..., d], d), steps[..., d]) for d in range(4)],
            axis=-1,
        )
        after = np.stack((np.roll(steps, 1, axis=-1), np.roll(steps, -1, axis=-1), forward), axis=-1)
        shorter = np.minimum(steps, np.where(passable[..., None], after.min(axis=-1) + 1, np.inf))
        if (shorter == steps).all():
            return after
        steps = shorter


def _passed(best: NDArray[np.bool_], here: tuple[int, int, int]) -> NDArray[np.bool_]:
    """Poses on the paths of best moves from a pose."""
    passed, open_poses = np.zeros(best.shape[:3], bool), [here]
    while open_poses:
        x, y, d = pose = open_poses.pop()
        if passed[pose]:
            continue
        passed[pose] = True
        dx, dy = _DIRECTIONS[d]
        following = {LEFT: (x, y, (d - 1) % 4), RIGHT: (x, y, (d + 1) % 4), FORWARD: (x + dx, y + dy, d)}
        open_poses += [pose for move, pose in following.items() if best[(x, y, d)][move]]
    return passed
