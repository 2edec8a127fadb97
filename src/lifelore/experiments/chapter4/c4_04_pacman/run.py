"""C4.4: policy reuse, PRQ and Q-learning on Pacman. Thesis: §4.6.3, Figure 4.8."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.pacman.pacman import PacmanMaze
from lifelore.experiments.chapter4.c4_04_pacman.pacman_reuse import run_cell

__all__ = ["cells", "check", "run_cell"]


def cells(settings: Mapping) -> list[dict]:
    return [{"layout": layout} for layout in range(settings["layouts"])]


def check(settings: Mapping) -> None:
    looks = [0, *settings["checkpoints"], settings["episodes"]]
    if any(not isinstance(look, int) for look in looks) or (np.diff(looks) < 1).any():
        raise InputError(f"checkpoints must rise between 0 and episodes, got {settings['checkpoints']}")
    PacmanMaze(settings["rows"], settings["columns"])
