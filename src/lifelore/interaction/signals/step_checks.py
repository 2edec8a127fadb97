"""The check of steps against the size of a step table."""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError


def check_steps(steps: NDArray[np.int64], shape: tuple[int, int, int]) -> None:
    """Raise InputError for steps (n, 3) outside (n_states, n_actions, n_outcomes)."""
    if len(steps) and not ((steps >= 0).all() and (steps < shape).all()):
        bad = steps[((steps < 0) | (steps >= shape)).any(axis=1)][0]
        raise InputError(f"each step must be below {shape} (states, actions, outcomes), got {tuple(bad.tolist())}")
