"""Q-learning on the errands of a maze, with advice in its ε branch and without, for claims C3.15 to C3.17.

Episodes have at most 200 steps, so that a goal far away is seldom met by chance. Thesis: §3.7.2.2, Alg. 2.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.learning.curve import Curve
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import QLearner, uniform_rows
from lifelore.core.mdp import Tables
from lifelore.core.streams import stream
from reproduction.chapter3.advice.mazes import Errand, Maze, errands_of


def errand_tables(maze: Maze, found: Errand, number: int, starts: str) -> Tables:
    """The tables of errand `number`, by where its episodes start.

    ``"one"``: a cell drawn for the task; ``"any"``: every cell; ``"walker's"``: where agents of fixed policy do.
    """
    if starts == "any":
        return found.tables
    if starts == "walker's":
        random = random_state(stream(*maze.names, "walk", number))
        first = int(next_uniform(random) * len(found.tables.starts))
        return found.tables._replace(starts=found.tables.starts[first : first + 1])
    start = stream(*maze.names, "start", number).choice(found.tables.starts, 1)
    return found.tables._replace(starts=start.astype(np.int32))


def learn_errand(
    settings: Mapping,
    maze: Maze,
    tables: Tables,
    number: int,
    schedule: Sequence[float],
    advice: NDArray[np.float64] | None = None,
    episodes: int | None = None,
) -> tuple[QLearner, Curve]:
    """One task learnt; `advice` (n_states, 4) is what its ε branch follows, uniform by default."""
    n_episodes = episodes or settings["episodes"]
    learning = QLearning(n_episodes, settings["max_episode_steps"], settings["learning_rate"], *schedule)
    world, own = (stream(*maze.names, "learner", number, of) for of in ("world", "own"))
    rows = uniform_rows(tables, advice)
    return learning.learn(tables, maze.world.discount, world=world, own=own, rows=rows)


def learn_errands(settings: Mapping, maze: Maze, starts: str, *how) -> list[tuple[QLearner, Curve]]:
    """All ``tasks`` of a maze learnt; `how` goes on to `learn_errand`."""
    return [
        learn_errand(settings, maze, errand_tables(maze, found, number, starts), number, *how)
        for number, found in enumerate(errands_of(maze, settings["tasks"]))
    ]
