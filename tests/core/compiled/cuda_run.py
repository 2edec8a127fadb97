"""Every (state, action) of small tasks through `CudaTask`, written to an npz; the tests run it in a process.

A GPU is simulated or not from the start of Python on, so a test cannot do this in its own process.
"""

import sys

import numpy as np

from lifelore.core.mdp import COLLISION, NOTHING, TERMINAL, Domain, Task
from lifelore.domains.factory.factory import Factory
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze
from lifelore.domains.pacman import pacman

SEED = 0


def slippery(params, s, a, u):
    """Plain Python: to the left or right on a strip, and by accident not at all."""
    length, slip = params
    if u < slip:
        return s, -0.5, COLLISION
    target = s + 2 * a - 1
    if target < 0 or target >= length:
        return s, 1.0, TERMINAL
    return target, 0.0, NOTHING


def factory_task() -> Task:
    floor = GridWorld.from_free("floor", np.ones((3, 3), bool))
    area = np.zeros(9, bool)
    points = np.array([[0, 2], [6, 8]], np.int32)
    return Factory(floor, points[0], points[1], np.arange(9) == 4, 3, area, area).task([0, 1])


def pacman_task() -> Task:
    maze = pacman.PacmanMaze(5, 3)
    one = pacman.PacmanTask(maze, (0, 1, 2, 3), "random")
    n_outcomes = one.params[4].size
    probs = np.full(n_outcomes, 1 / n_outcomes)
    domain = Domain("pacman", one.n_states, pacman.N_ACTIONS, pacman.step, 0.95, probs)
    return Task(domain, one.params, one.starts)


def tasks() -> dict[str, Task]:
    """A task of each `step` of ours, and one of a `step` in plain Python."""
    strip = Domain("strip", 5, 2, slippery, 0.9, (0.25, 0.75))
    return {
        "lattice": lattice(11).task(goal=0),
        "noise": noise_maze(np.random.default_rng(SEED), size=11).task(goal=7),
        "factory": factory_task(),
        "pacman": pacman_task(),
        "strip": Task(strip, (5, 0.25), np.arange(5)),
    }


def pairs(task: Task) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Every state with every action, and a uniform for each."""
    states, actions = np.indices((task.domain.n_states, task.domain.n_actions)).reshape(2, -1)
    return states, actions, np.random.default_rng(SEED).random(states.size)


if __name__ == "__main__":
    from lifelore.core.compiled.cuda import CudaTask

    np.savez(
        sys.argv[1],
        **{
            f"{name} {what}": array
            for name, task in tasks().items()
            for what, array in CudaTask(task).step_many(*pairs(task))._asdict().items()
        },
    )
