"""Writes the files for other programs, in metres: greedy paths as CSV, the prior as a ROS map."""

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.output.greedy_paths import GreedyPaths
from lifelore.core.metrics import entropy
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.occupancy_map import write_occupancy_map
from lifelore.domains.grids.grid_world import GridWorld

NO_PRIOR = 255
"""Grey value of cells that are no floor or have no counts; `map_server` reads it as unknown."""
_MEANING = (
    "# How decided the action prior is in each cell: 0 % all moves are equally likely, 100 % one is certain.\n"
    "# 255: no floor, or no experience. One pixel is one cell; read with mode raw.\n"
)


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


def decided_percent(world: GridWorld, probs: NDArray[np.float64], counted: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """How decided the prior of each cell is, in percent: 100 · (1 - entropy / log |A|); (rows, columns) uint8."""
    nats = entropy(probs)
    percent = np.rint(100 * np.clip(1 - nats / np.log(probs.shape[1]), 0, 1))
    grey = np.full(world.shape, NO_PRIOR, np.uint8)
    grey[tuple(world.cells.T)] = np.where(counted, percent, NO_PRIOR)
    return grey


def write_prior_map(path: Path, world: GridWorld, probs: NDArray[np.float64], counted: NDArray[np.bool_]) -> None:
    """Write the prior as a `map_server` map with one pixel a cell, and the origin and yaw of the world.

    Parameters
    ----------
    path : Path
        The YAML file; the image has the same name with the ending ``.pgm``.
    world : GridWorld
    probs : (n_states, n_actions) float
        Rows sum to 1.
    counted : (n_states,) bool
        States whose context has counts.

    Raises
    ------
    StoreError
        The files cannot be written.
    """
    grey = decided_percent(world, probs, counted)
    write_occupancy_map(path, grey, world.frame.cell, world.frame.origin, mode="raw")
    path.write_text(_MEANING + path.read_text(encoding="utf-8"), encoding="utf-8")
