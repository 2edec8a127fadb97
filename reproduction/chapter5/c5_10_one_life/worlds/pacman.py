"""Pacman of the thesis (§4.6.3), in a small maze, with a ghost whose strategy is hidden."""

from functools import cache

import gymnasium

from lifelore.core.streams import stream
from lifelore.domains.pacman.environment import PacmanEnvironment
from lifelore.domains.pacman.pacman import STRATEGIES, PacmanMaze
from reproduction.chapter5.c5_10_one_life.worlds.family import Family

ROWS, COLUMNS = 5, 3
"""Free cells of the maze: two loops of eight cells that share three."""


@cache
def _maze() -> PacmanMaze:
    return PacmanMaze(ROWS, COLUMNS)


def make(strategy: str, seed: int) -> gymnasium.Env:
    """The foods of a life, and a ghost."""
    foods = _maze().draw_foods(stream(seed, "C5.10", "foods"))
    return PacmanEnvironment(strategy, ROWS, COLUMNS, foods)


@cache
def features(observation: int) -> tuple[tuple[bool, ...], tuple[int, int] | None]:
    """Walls around, and where the ghost is as seen from Pacman: rows and columns, None if unseen."""
    maze = _maze()
    own, ghost = observation // (maze.n_cells + 1) % maze.n_cells, observation % (maze.n_cells + 1)
    walls = tuple((maze.grid.neighbour[own] < 0).tolist())
    if ghost == maze.n_cells:
        return walls, None
    row, column = (maze.grid.cells[ghost] - maze.grid.cells[own]).tolist()
    return walls, (row, column)


PACMAN = Family(STRATEGIES, make, int, features, max_steps=60, learner="model")
