"""C4.4: on Pacman, Bayesian policy reuse converges orders of magnitude sooner than PRQ and than Q-learning.

What each is given: BPR and PRQ four policies trained beforehand for the task's own foods, one a ghost; BPR also
how each returned against each ghost; Q-learning nothing. Training is counted in `training_episodes`. Tasks of one
layout share a library: intervals are over layouts. Thesis: §4.6.3, Figure 4.8.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.pacman.pacman import PacmanMaze
from lifelore.experiments.chapter4.c4_04_pacman.pacman_reuse import run_cell

__all__ = ["cells", "check", "run_cell"]


def cells(settings: Mapping) -> list[dict]:
    return [{"layout": layout} for layout in range(settings["layouts"])]


def check(settings: Mapping) -> None:
    for key in ("layouts", "episodes", "window", "peer_episodes", "samples", "training_episodes"):
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")
    if not settings["window"] <= settings["peer_episodes"] <= settings["episodes"]:
        raise InputError(
            f"peer_episodes must lie between window ({settings['window']}) and episodes "
            f"({settings['episodes']}), got {settings['peer_episodes']}"
        )
    if settings["more_samples"] < settings["samples"]:
        raise InputError(f"more_samples must be at least samples, got {settings['more_samples']}")
    for key in ("rate", "epsilon", "tolerance", "training_discount", "training_rate", "training_epsilon"):
        if not 0 <= settings[key] <= 1:
            raise InputError(f"{key} must lie in [0, 1], got {settings[key]}")
    looks = [0, *settings["checkpoints"], settings["episodes"]]
    if any(not isinstance(look, int) for look in looks) or (np.diff(looks) < 1).any():
        raise InputError(f"checkpoints must rise between 0 and episodes, got {settings['checkpoints']}")
    PacmanMaze(settings["rows"], settings["columns"])
