"""Estimates the noise of logged poses from how far they lie beside the line through their neighbours."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.learn_from.run_log import Run

AT_REST = 1e-3
"""Metres that a pose has to move to count."""
LAGS = (1, 2, 3)
"""Poses between a pose and its neighbours. Noise is the same at all lags; a way of many turns differs."""
_TO_SIGMA = 1.4826 / np.sqrt(1.5)
"""σ of a pose, from the median distance to the line through two neighbours of the same noise: a median of 0.6745
standard deviations, whose variance is σ² + σ²/4 + σ²/4."""


def localisation_noise(runs: Sequence[Run]) -> float:
    """Standard deviation in metres, along each axis, of the jitter of poses; 0 for runs of few moving poses.

    The median leaves out single turns, and noise that changes slowly does not show.
    """
    medians = []
    for lag in LAGS:
        found = np.concatenate([np.empty(0), *(_beside(run.points, lag) for run in runs)])
        medians.append(float(np.median(found)) if len(found) else 0.0)
    return min(medians) * _TO_SIGMA


def _beside(points: NDArray[np.float64], lag: int) -> NDArray[np.float64]:
    """Distances in metres of the poses that moved to the line through the poses `lag` before and after them."""
    before, here, after = points[: -2 * lag], points[lag:-lag], points[2 * lag :]
    line, offset = after - before, here - (before + after) / 2
    length = np.hypot(*line.T)
    moved = (length > AT_REST) & (np.hypot(*(here - before).T) > AT_REST)
    across = np.abs(line[:, 0] * offset[:, 1] - line[:, 1] * offset[:, 0])
    return across[moved] / length[moved]
