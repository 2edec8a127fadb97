"""Computes the paths that a learnt policy takes through a grid world."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.domains.grids.grid_world import GridWorld


@dataclass(frozen=True, eq=False)
class GreedyPaths:
    """Greedy paths of one task.

    task : number of the task in the robot's life
    goal : state
    paths : states of each path, from its start on
    arriving : share of the task's starts from which the policy reaches the goal, in [0, 1]
    goal_point, name : x and y in metres, and name of the goal, if the user gave them
    """

    task: int
    goal: int
    paths: list[NDArray[np.int32]]
    arriving: float
    goal_point: tuple[float, float] | None = None
    name: str | None = None


def greedy_path(world: GridWorld, policy: ArrayLike, start: int, goal: int) -> NDArray[np.int32]:
    """The states that following `policy` visits, `start` first.

    Parameters
    ----------
    world : GridWorld
    policy : (n_states,) int
        Action of each state, -1 where none is known.
    start, goal : int
        States.

    Returns
    -------
    (n,) int32
        Ends with `goal` if the policy reaches it. Otherwise it ends where the policy has no action, hits a wall
        or returns to a state of the path. No state occurs twice.
    """
    policy = np.asarray(policy)
    path, seen, state = [start], {start}, start
    while state != goal and policy[state] >= 0:
        state = int(world.neighbour[state, policy[state]])
        if state < 0 or state in seen:
            break
        path.append(state)
        seen.add(state)
    return np.array(path, np.int32)


def path_lengths(world: GridWorld, policy: ArrayLike, goal: int) -> NDArray[np.int32]:
    """Moves that `policy` needs from each state to `goal`, (n_states,); -1 where it never reaches the goal."""
    policy = np.asarray(policy)
    states = np.arange(world.n_states)
    following = world.neighbour[states, np.maximum(policy, 0)]
    following = np.where((policy < 0) | (following < 0) | (states == goal), states, following)
    length = np.full(world.n_states, -1, np.int32)
    length[goal] = 0
    moved = True
    while moved:
        arrived = (length < 0) & (length[following] >= 0)
        length[arrived] = length[following[arrived]] + 1
        moved = bool(arrived.any())
    return length


def greedy_paths_of(
    world: GridWorld, policy: ArrayLike, task: int, goal: int, start: int | None = None, n_paths: int = 3
) -> GreedyPaths:
    """Paths of a task from up to `n_paths` starts that are far apart; the first is the farthest from the goal.

    Starts from which the policy never reaches the goal are left out. If `start` is given, it is the only start.
    """
    length = path_lengths(world, policy, goal)
    starts = np.delete(np.arange(world.n_states), goal) if start is None else np.array([start])
    arriving = starts[length[starts] > 0]
    chosen = _far_apart(world, arriving, length, goal, n_paths)
    paths = [greedy_path(world, policy, state, goal) for state in chosen]
    return GreedyPaths(task, goal, paths, len(arriving) / len(starts))


def _far_apart(world: GridWorld, states: NDArray, length: NDArray, goal: int, n: int) -> list[int]:
    chosen: list[int] = []
    if not len(states):
        return chosen
    nearest = np.linalg.norm(world.cells[states] - world.cells[goal], axis=1)
    state = int(states[length[states].argmax()])
    while len(chosen) < n:
        chosen.append(state)
        nearest = np.minimum(nearest, np.linalg.norm(world.cells[states] - world.cells[state], axis=1))
        if not nearest.any():
            break
        state = int(states[nearest.argmax()])
    return chosen
