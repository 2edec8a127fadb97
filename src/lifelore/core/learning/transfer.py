"""Measures of transfer and forgetting over a lifetime of tasks.

The input is evaluations, (..., n_tasks + 1, n_tasks): the performance on task j before any learning (row 0) and
after each task (row i + 1); tasks are learned once each, in the order of the columns. Evaluations teach nothing.
Leading axes are lives. Larger is better.

Transfer as differences is Lopez-Paz & Ranzato's, Gradient Episodic Memory (2017); row 0 is their agent at
random initialisation. Forgetting is Chaudhry et al.'s, Riemannian Walk (2018). Maintenance is New et al.'s,
Lifelong Learning Metrics (2022). `mean_estimate` of the values by life gives an interval.
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate

Values = NDArray[np.float64]


def average_performance(evaluations: ArrayLike) -> Values:
    """Mean performance on all tasks at the end of the life (ACC), (...)."""
    return _checked(evaluations)[..., -1, :].mean(axis=-1)


def forward_transfer(evaluations: ArrayLike) -> Values:
    """FWT: what earlier tasks added to a task before it was learnt itself, mean over all but the first, (...)."""
    values = _checked(evaluations)
    before = np.diagonal(values[..., :-1, :], axis1=-2, axis2=-1)
    return (before - values[..., 0, :])[..., 1:].mean(axis=-1)


def backward_transfer(evaluations: ArrayLike) -> Values:
    """BWT: what later tasks added to a task since it was learnt, mean over all but the last, (...).

    Below zero is forgetting.
    """
    values = _checked(evaluations)
    return (values[..., -1, :] - _once_learnt(values))[..., :-1].mean(axis=-1)


def forgetting(evaluations: ArrayLike) -> Values:
    """How far each task ends below its best after any earlier task, mean over all but the last task, (...)."""
    values = _checked(evaluations)
    best = values[..., 1:-1, :].max(axis=-2)
    return (best - values[..., -1, :])[..., :-1].mean(axis=-1)


def performance_maintenance(evaluations: ArrayLike) -> Values:
    """PM: mean change since a task was learnt over all later evaluations, then over tasks, (...).

    The reference is the evaluation right after learning. The last task has no later one and takes no part.
    """
    values = _checked(evaluations)
    change = values[..., 1:, :] - _once_learnt(values)[..., None, :]
    n_tasks = values.shape[-1]
    return np.mean([change[..., j + 1 :, j].mean(axis=-1) for j in range(n_tasks - 1)], axis=0)


@dataclass(frozen=True)
class LifetimeTransfer:
    """Transfer over lifetimes, means over lives; see the functions of the same names."""

    average_performance: Estimate
    forward_transfer: Estimate
    backward_transfer: Estimate
    forgetting: Estimate
    performance_maintenance: Estimate

    def to_dict(self) -> dict:
        """Plain data."""
        return {field.name: getattr(self, field.name).to_dict() for field in fields(self)}


def lifetime_transfer(evaluations: ArrayLike, baseline: ArrayLike | None = None) -> LifetimeTransfer:
    """All transfer measures over lives, with 95 % intervals; with a `baseline`, the paired differences to it.

    Parameters
    ----------
    evaluations : (n_lives, n_tasks + 1, n_tasks) float
    baseline : (n_lives, n_tasks + 1, n_tasks) float, optional
        Another agent's, in the same lives.

    Examples
    --------
    >>> life = [[0, 0, 0], [4, 2, 2], [3, 6, 3], [3, 5, 8]]
    >>> found = lifetime_transfer([life, life])
    >>> found.forward_transfer.value, found.backward_transfer.value, found.forgetting.value
    (2.5, -1.0, 1.0)
    """
    values = _checked(evaluations)
    if values.ndim != 3:
        raise InputError(f"evaluations must be (n_lives, n_tasks + 1, n_tasks), got {values.shape}")
    if baseline is None:
        return LifetimeTransfer(*(mean_estimate(measure(values)) for measure in _MEASURES))
    others = _checked(baseline)
    if others.shape != values.shape:
        raise InputError(f"baseline must be of the same lives, {values.shape}, got {others.shape}")
    return LifetimeTransfer(*(difference_estimate(measure(values), measure(others)) for measure in _MEASURES))


_MEASURES = (average_performance, forward_transfer, backward_transfer, forgetting, performance_maintenance)


def _once_learnt(values: Values) -> Values:
    """Performance on each task right after it was learnt, (..., n_tasks)."""
    return np.diagonal(values[..., 1:, :], axis1=-2, axis2=-1)


def _checked(evaluations: ArrayLike) -> Values:
    values = np.asarray(evaluations, np.float64)
    if values.ndim < 2 or values.shape[-1] < 2 or values.shape[-2] != values.shape[-1] + 1:
        raise InputError(
            f"evaluations must be (..., n_tasks + 1, n_tasks) of at least two tasks, got {values.shape}; "
            "row 0 is the performance before any learning"
        )
    if not values.size or not np.isfinite(values).all():
        raise InputError("evaluations must be finite and of at least one life")
    return values
