"""C3.17: advice given per 100 steps as κ grows, and how it falls for Q-learning as it learns.

Beside the curves stands the ceiling of the divergence: the share of states where κ can be met at all. Whether the
agents of Figure 3.23 followed the advice is not printed: both are measured. A walk that reaches its goal ends.
Thesis: §3.7.2.3, Figure 3.23.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.advice_estimates import check_grid
from lifelore.experiments.chapter3.advice_grid import maze_cells as cells
from lifelore.experiments.chapter3.advised_learning import STARTS
from lifelore.experiments.chapter3.c3_17_advice_cost.advice_amount import run_cell

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_grid(settings, ("tasks", "max_steps", "max_episode_steps"))
    kappas, snapshots = settings["kappas"], settings["snapshots"]
    if kappas[:1] != [0.0] or settings["kappa"] not in kappas or sorted(set(kappas)) != kappas:
        raise InputError(f"kappas must rise from 0 and contain kappa ({settings['kappa']}), got {kappas}")
    if not snapshots or sorted(set(snapshots)) != snapshots or snapshots[0] < 1:
        raise InputError(f"snapshots must be rising numbers of episodes, got {snapshots}")
    if settings["q_starts"] not in STARTS:
        raise InputError(f"q_starts must be one of {', '.join(STARTS)}, got '{settings['q_starts']}'")
    if np.shape(settings["schedule"]) != (3,) or not all(0 <= x <= 1 for x in settings["schedule"]):
        raise InputError(f"schedule must be three numbers in [0, 1], got {settings['schedule']}")
    if not isinstance(settings["default"].get("heeds"), bool):
        raise InputError(f"default must say whether agents heed, true or false, got {settings['default']}")
