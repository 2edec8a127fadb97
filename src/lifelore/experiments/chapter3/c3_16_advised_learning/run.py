"""C3.16: Q-learning with advice in its ε branch finds its goal within a handful of episodes; without, it does not.

ε and its annealing, and where a task's episodes start, are not printed: they are crossed with the maze's loops and
the kinds of experts. Tasks of one maze are not independent: intervals are over mazes. Thesis: §3.7.2, Figure 3.22.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.advice_estimates import check_grid
from lifelore.experiments.chapter3.advice_grid import maze_cells as cells
from lifelore.experiments.chapter3.advised_learning import STARTS, run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_grid(settings, ("tasks", "episodes", "max_episode_steps", "last"))
    if settings["last"] > settings["episodes"]:
        raise InputError(f"last must be at most episodes ({settings['episodes']}), got {settings['last']}")
    if not 0 <= settings["learning_rate"] <= 1:
        raise InputError(f"learning_rate must lie in [0, 1], got {settings['learning_rate']}")
    if not settings["starts"] or not set(settings["starts"]) <= set(STARTS):
        raise InputError(f"starts must be among {', '.join(STARTS)}, got {settings['starts']}")
    for schedule in settings["schedules"]:
        if np.shape(schedule) != (3,) or not all(0 <= x <= 1 for x in schedule):
            raise InputError(
                f"schedules must each be three numbers in [0, 1], first ε, factor and floor, got {schedule}"
            )
    default = settings["default"]
    if default.get("starts") not in settings["starts"] or default.get("schedule") not in settings["schedules"]:
        raise InputError(f"default must be a cell of the grid of starts and schedules, got {default}")
