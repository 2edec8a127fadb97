"""Measures of transfer and forgetting over a lifetime of tasks.

The input is evaluations, (n_lives, n_tasks + 1, n_tasks): the performance on task j before any learning (row 0)
and after each task (row i + 1); tasks are learned once each, in the order of the columns. Evaluations teach
nothing. Larger is better.

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


@dataclass(frozen=True)
class LifetimeTransfer:
    """Transfer over lifetimes, means over lives.

    average_performance : ACC, mean performance on all tasks at the end of the life
    forward_transfer : FWT, what earlier tasks added to a task before it was learnt itself; not of the first task
    backward_transfer : BWT, what later tasks added to a task since it was learnt; not of the last task. Below zero
        is forgetting.
    forgetting : how far each task ends below its best after any earlier task; not of the last task
    performance_maintenance : PM, mean change since a task was learnt over all later evaluations, then over tasks;
        not of the last task
    """

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
    if baseline is None:
        return LifetimeTransfer(*map(mean_estimate, _measures(values)))
    others = _checked(baseline)
    if others.shape != values.shape:
        raise InputError(f"baseline must be of the same lives, {values.shape}, got {others.shape}")
    return LifetimeTransfer(*map(difference_estimate, _measures(values), _measures(others)))


def _measures(values: Values) -> list[Values]:
    """The fields of `LifetimeTransfer` of each life, (n_lives,) each."""
    at_first, at_last, n_tasks = values[:, 0], values[:, -1], values.shape[-1]
    before, learnt = (np.diagonal(part, axis1=-2, axis2=-1) for part in (values[:, :-1], values[:, 1:]))
    best, change = values[:, 1:-1].max(axis=1), values[:, 1:] - learnt[:, None]
    kept = [change[:, task + 1 :, task].mean(axis=1) for task in range(n_tasks - 1)]
    return [
        at_last.mean(axis=1),
        (before - at_first)[:, 1:].mean(axis=1),
        (at_last - learnt)[:, :-1].mean(axis=1),
        (best - at_last)[:, :-1].mean(axis=1),
        np.mean(kept, axis=0),
    ]


def _checked(evaluations: ArrayLike) -> Values:
    values = np.asarray(evaluations, np.float64)
    if values.ndim != 3 or values.shape[2] < 2 or values.shape[1] != values.shape[2] + 1:
        raise InputError(
            f"evaluations must be (n_lives, n_tasks + 1, n_tasks) of at least two tasks, got {values.shape}; "
            "row 0 is the performance before any learning"
        )
    if not values.size or not np.isfinite(values).all():
        raise InputError("evaluations must be finite and of at least one life")
    return values
