"""C3.18: advice raises P(M₁ | H), the probability that an explorer acts as the experts do.

Partly so by construction: an advised step is drawn from θ, which is M₁. So it is measured three times: all steps
in H, as the thesis does; H of the agent's own steps alone; and all steps in H, read only where no advice was
given. The last is chosen by what it measures: no advice is given where P(M₁ | H) is high.
Thesis: §3.7.2.3, Figure 3.21.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.advice_estimates import check_grid
from lifelore.experiments.chapter3.advice_grid import maze_cells as cells
from lifelore.experiments.chapter3.advised_explorers import run_normalcy_cell as run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_grid(settings, ("tasks", "max_steps", "blocks"))
    if settings["max_steps"] % settings["blocks"]:
        raise InputError(f"blocks must divide max_steps ({settings['max_steps']}), got {settings['blocks']}")
