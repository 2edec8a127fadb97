"""Estimates the noise of logged poses from how far they lie beside the line through their neighbours."""

from collections.abc import Sequence

import numpy as np

from lifelore.agent.learn_from.run_log import Run

_TO_SIGMA = 1.4826 / np.sqrt(1.5)
"""σ of a pose, from the median distance to the line through two neighbours of the same noise: a median of 0.6745
standard deviations, whose variance is σ² + σ²/4 + σ²/4."""


def localisation_noise(runs: Sequence[Run]) -> float:
    """Standard deviation in metres, along each axis, of the jitter of poses; 0 for fewer than three moving poses.

    The median leaves out turns, and noise that changes slowly does not show.
    """
    beside = [_beside(run) for run in runs]
    found = np.concatenate(beside) if beside else np.empty(0)
    return float(np.median(found) * _TO_SIGMA) if len(found) else 0.0


def _beside(run: Run) -> np.ndarray:
    """Distances in metres of the inner poses that moved to the line through the poses before and after."""
    before, here, after = run.points[:-2], run.points[1:-1], run.points[2:]
    line, offset = after - before, here - (before + after) / 2
    length = np.hypot(*line.T)
    moved = (length > 1e-3) & (np.hypot(*(here - before).T) > 1e-3)
    across = np.abs(line[:, 0] * offset[:, 1] - line[:, 1] * offset[:, 0])
    return across[moved] / length[moved]
