"""Computes the paths that a learnt policy takes through a grid world, and writes them in metres."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.agent.live.driven.drive_job import DrivenJob
from lifelore.agent.live.driven.route import chain_to
from lifelore.agent.live.grid_life import TASKS_WITH_POLICY
from lifelore.agent.live.life import Life
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.grids.grid_world import GridWorld

N_PATHS = 3
"""Largest number of paths of a task; more make the picture harder to read."""


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


def last_paths(life: Life) -> list[GreedyPaths]:
    """Paths of the first agent in the last tasks: driven, or greedy by its policy."""
    if not life.results:
        return []
    world, name = life.world, next(iter(life.results[0]))
    last = zip(life.report["tasks"][-TASKS_WITH_POLICY:], life.results[-TASKS_WITH_POLICY:], strict=True)
    paths = []
    for task, result in last:
        goal = int(world.state_of[tuple(task["goal"])])
        of, point = result[name], task.get("position")
        if isinstance(of, DrivenJob):
            found = GreedyPaths(task["index"], goal, of.paths(), float(of.reached))
        else:
            found = greedy_paths_of(world, of.policy, task["index"], goal, life.start)
        reached = point and found.arriving > 0
        paths.append(replace(found, goal_point=tuple(point) if reached else None, name=task.get("name")))
    return paths


def greedy_paths_of(
    world: GridWorld, policy: ArrayLike, task: int, goal: int, start: int | None = None
) -> GreedyPaths:
    """Paths of a task from up to `N_PATHS` starts that are far apart; the first is the farthest from the goal.

    Starts from which the policy never reaches the goal are left out. If `start` is given, it is the only start.
    `policy` (n_states,) has the action of each state, -1 where none is known.
    """
    action = np.asarray(policy)
    after = np.where(action >= 0, world.neighbour[np.arange(world.n_states), action], -1)
    moved = np.flatnonzero(after >= 0)
    back = sparse.csr_array((np.ones(len(moved)), (after[moved], moved)), shape=(world.n_states,) * 2)
    length, following = csgraph.dijkstra(back, indices=goal, unweighted=True, return_predecessors=True)
    starts = np.delete(np.arange(world.n_states), goal) if start is None else np.array([start])
    arriving = starts[(length[starts] > 0) & np.isfinite(length[starts])]
    chosen = _far_apart(world, arriving, length, goal)
    paths = [np.array(chain_to(state, goal, following)[::-1], np.int32) for state in chosen]
    return GreedyPaths(task, goal, paths, len(arriving) / len(starts))


def _far_apart(world: GridWorld, states: NDArray, length: NDArray, goal: int) -> list[int]:
    chosen: list[int] = []
    if not len(states):
        return chosen
    nearest = np.linalg.norm(world.cells[states] - world.cells[goal], axis=1)
    state = int(states[length[states].argmax()])
    while len(chosen) < N_PATHS:
        chosen.append(state)
        nearest = np.minimum(nearest, np.linalg.norm(world.cells[states] - world.cells[state], axis=1))
        if not nearest.any():
            break
        state = int(states[nearest.argmax()])
    return chosen


def path_points(world: GridWorld, task: GreedyPaths, floor: Floor | None = None) -> list[NDArray[np.float64]]:
    """The paths of a task as lines, each (n, 2) x and y in metres of the map's frame.

    With the `floor` of a building, a line has the ends of a greedy path and is the shortest between them that is
    clear of obstacles by the robot's radius. Without a floor, it goes from the centre of each cell to the next.
    """
    if floor is None:
        return [world.positions(states) for states in task.paths]
    return [_clear(floor, states, task.goal_point) for states in task.paths]


def write_paths(path: Path, lines: Mapping[int, Sequence[NDArray[np.float64]]]) -> None:
    """Write paths as CSV: task, path (from 0 in each task), step (a point of the line), x and y.

    Parameters
    ----------
    path : Path
    lines : mapping of int to sequence of (n, 2) float64
        By number of the task, as `path_points` makes them.
    """
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["task", "path", "step", "x", "y"])
        for task, paths in lines.items():
            for number, points in enumerate(paths):
                for step, (x, y) in enumerate(points):
                    writer.writerow([task, number, step, f"{x:.4f}", f"{y:.4f}"])


def _clear(floor: Floor, states: NDArray[np.int32], goal: tuple[float, float] | None) -> NDArray[np.float64]:
    """The shortest clear path between the ends of a greedy path, or to the goal's point if the user gave one."""
    from lifelore.domains.buildings.clear_path import clear_path

    start, end = floor.metres(floor.anchors[states[[0, -1]]])
    path = clear_path(floor, start, end if goal is None else goal)
    assert path is not None, "the places of a floor are joined"
    return path
