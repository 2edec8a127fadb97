"""The thesis's worlds as ours draws them: Figures 3.2, 3.4, 3.6, 3.10, 3.18 and 3.20.

``python -m docs.pictures.worlds`` writes them to ``docs/pictures/worlds.png``. How the factory's
points and routes lie, and the mazes' corridors, is our drawing: the thesis's pictures are not data.
"""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from docs.pictures.factory_picture import draw_factory
from docs.pictures.figure_world_plates import draw_world_plates
from lifelore.action.advice.goal_model import GoalModel, Trajectory
from lifelore.core.streams import stream
from lifelore.domains.advice.advice_maze import advice_maze, maze_goals
from lifelore.domains.factory.layout import factory
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.domains.grids.grid_picture import GOAL_COLOUR, draw_grid
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze
from lifelore.figures.style import save_figure

PATH = Path("docs/pictures/worlds.png")
DENSITIES = (0.5, 0.8)
REGION = 3
WALKS = ((7, 4, 1), (3, 4, 1), (3, 4, 5))
"""Figure 3.18: three walks through a region of 3 × 3 cells, two of which go on north from its centre, one east."""


def pictures() -> Iterator[tuple[str, NDArray[np.uint8]]]:
    """Title and picture of each world, at the thesis's sizes."""
    yield "lattice, 23 × 23 (3.2)", draw_grid(lattice())
    for density in DENSITIES:
        draw = stream(0, "world plates", "noise", str(density))
        maze = noise_maze(draw, density=density)
        start, goal = (int(state) for state in draw.choice(maze.n_states, 2, replace=False))
        yield f"noise, {density:.0%} (3.4)", draw_grid(maze, start, goal)
    yield "factory (3.6)", draw_factory(factory())
    for number in range(2):
        drawn = modified_factory(stream(number, "world plates", "modified factory"))
        yield f"modified factory, {number + 1} of 2 (3.10)", draw_factory(drawn)
    yield "advice maze, 30 × 30 (3.20)", _with_goals(advice_maze(stream(0, "world plates", "advice")))


def walked() -> dict:
    """What Figure 3.18 shows: a prior from three walks, where anybody walked."""
    cells = np.indices((REGION, REGION)).reshape(2, -1).T
    moves = {(-1, 0): 0, (1, 0): 1, (0, 1): 2, (0, -1): 3}
    ways = []
    for walk in WALKS:
        actions = [moves[tuple((cells[b] - cells[a]).tolist())] for a, b in pairwise(walk)]
        ways.append(Trajectory(np.array(walk), np.array(actions)))
    theta = GoalModel.from_trajectories(ways, len(cells), 4).theta
    shape = {"shape": (REGION, REGION), "cells": cells, "probs": theta}
    return shape | {"title": "a prior from three walks (3.18)", "walks": [cells[list(walk)] for walk in WALKS]}


def _with_goals(maze: GridWorld) -> NDArray[np.uint8]:
    picture = draw_grid(maze)
    side = len(picture) // maze.shape[0]
    for row, column in maze.cells[maze_goals(maze)] * side:
        picture[row : row + side, column : column + side] = GOAL_COLOUR
    return picture


if __name__ == "__main__":
    print(save_figure(draw_world_plates(list(pictures()), walked()), PATH))
