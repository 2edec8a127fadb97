"""C3.15: Table 3.1, explorers and Q-learning in a maze with advice and without, and the better advisor beside.

What decides the table is not printed: how the maze loops, and how its experts walked. Both are crossed, and one
stated default is the headline. The better advisor goes beyond the thesis: what is asked of it is reported, and
takes no part in the verdict. Thesis: §3.7.2, Table 3.1.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.advice_estimates import check_grid
from lifelore.experiments.chapter3.advice_grid import maze_cells as cells
from lifelore.experiments.chapter3.advised_explorers import run_cell
from lifelore.experiments.chapter3.advised_learning import LEARNING

__all__ = ["cells", "check", "run_cell"]
Q_LEARNING = {**LEARNING, "schedule": [1.0, 0.999, 0.05]}


def check(settings: Mapping) -> None:
    check_grid(settings, ("tasks", "max_steps"))
    learning = settings["q_learning"]
    if set(learning) != set(Q_LEARNING):
        raise InputError(f"q_learning must have exactly {', '.join(Q_LEARNING)}, got {', '.join(learning)}")
    if not 1 <= learning["tasks"] <= settings["tasks"] or not 1 <= learning["last"] <= learning["episodes"]:
        raise InputError(
            f"q_learning must have tasks in [1, {settings['tasks']}] and last in [1, episodes], got {learning}"
        )
