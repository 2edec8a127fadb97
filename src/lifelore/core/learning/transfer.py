"""Measures of transfer and forgetting over a lifetime of tasks.

The input is evaluations, (..., n_tasks + 1, n_tasks): the performance on task j before any learning (row 0) and
after each task (row i + 1); tasks are learned once each, in the order of the columns. Evaluations teach nothing.
Leading axes are lives. Larger is better.

Transfer as differences is Lopez-Paz & Ranzato's, Gradient Episodic Memory (2017); row 0 is their agent at
random initialisation. Forgetting is Chaudhry et al.'s, Riemannian Walk (2018). Transfer between pairs of
tasks, maintenance, and measures relative to a single-task expert are New et al.'s, Lifelong Learning Metrics
(2022). `mean_estimate` of the values by life or task gives an interval.
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate

PAIR_FORMS = ("ratio", "contrast")

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


def pair_transfer(evaluations: ArrayLike, form: str = "ratio") -> Values:
    """What learning task i did to task j, (..., n_tasks, n_tasks): above the diagonal forward, below it backward.

    Parameters
    ----------
    evaluations : (..., n_tasks + 1, n_tasks) float
        At least 0: these forms mean nothing otherwise.
    form : {"ratio", "contrast"}
        after / before, or (after − before) / (after + before).

    Returns
    -------
    (..., n_tasks, n_tasks) float
        NaN on the diagonal, and where the denominator is 0.
    """
    values = _checked(evaluations)
    if form not in PAIR_FORMS:
        raise NotFoundError(f"form must be one of {', '.join(PAIR_FORMS)}, got '{form}'")
    if (values < 0).any():
        raise InputError(f"evaluations must be at least 0 for form '{form}', got {values.min():.6g}; shift them")
    before, after = values[..., :-1, :], values[..., 1:, :]
    above, below = (after, before) if form == "ratio" else (after - before, after + before)
    pairs = np.divide(above, below, out=np.full_like(before, np.nan), where=below != 0)
    pairs[..., np.eye(values.shape[-1], dtype=bool)] = np.nan
    return pairs


def mean_pair_transfer(evaluations: ArrayLike, form: str = "ratio") -> tuple[Values, Values]:
    """FT and BT of a life: means of `pair_transfer` over pairs, forward and backward, (...) each.

    Raises
    ------
    InputError
        A pair is undefined: the performance before it was 0 (of the contrast: and after it too).
    """
    pairs = pair_transfer(evaluations, form)
    place = np.triu_indices(pairs.shape[-1], 1)
    forward, backward = pairs[..., *place], np.swapaxes(pairs, -1, -2)[..., *place]
    if np.isnan(forward).any() or np.isnan(backward).any():
        raise InputError(f"evaluations must leave no pair of form '{form}' undefined, got a 0; shift performance")
    return forward.mean(axis=-1), backward.mean(axis=-1)


def relative_performance(curves: ArrayLike, expert: ArrayLike) -> Values:
    """RP of each task: total performance in learning over a single-task expert's in as many episodes, (n_tasks,).

    Parameters
    ----------
    curves, expert : (n_tasks, n_episodes) float
        Learning curves in the life, and of a learner that meets the task alone; the longer are cut to the shorter.
    """
    own, other = _with_expert(curves, expert)
    below = other.sum(axis=1)
    if not (below > 0).all():
        raise InputError(
            f"expert must have a positive total in every task, got {below.min():.6g}; shift performance"
        )
    return own.sum(axis=1) / below


def sample_efficiency(curves: ArrayLike, expert: ArrayLike, window: int = 1) -> Values:
    """SE of each task: ratio of saturation to an expert's, times its ratio of episodes to saturation, (n_tasks,).

    Saturation is the largest moving mean over `window` episodes; episodes to it are those run when it is first
    met. Above 1: higher, sooner, or both. L2Metrics smooths over a fifth of the episodes, mirrored at the ends,
    and counts from 0.
    """
    own, other = _with_expert(curves, expert, cut=False)
    level, episodes = _saturation(own, window)
    expert_level, expert_episodes = _saturation(other, window)
    if not (expert_level > 0).all():
        raise InputError(
            f"expert must saturate above 0 in every task, got {expert_level.min():.6g}; shift performance"
        )
    return (level / expert_level) * (expert_episodes / episodes)


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


def _saturation(curves: Values, window: int) -> tuple[Values, Values]:
    if not 1 <= window <= curves.shape[1]:
        raise InputError(f"window must lie in [1, {curves.shape[1]}], got {window}")
    smooth = np.lib.stride_tricks.sliding_window_view(curves, window, axis=1).mean(axis=-1)
    return smooth.max(axis=1), smooth.argmax(axis=1) + float(window)


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


def _with_expert(curves: ArrayLike, expert: ArrayLike, cut: bool = True) -> tuple[Values, Values]:
    own, other = np.asarray(curves, np.float64), np.asarray(expert, np.float64)
    for name, array in (("curves", own), ("expert", other)):
        if array.ndim != 2 or not array.size or not np.isfinite(array).all():
            raise InputError(f"{name} must be finite and (n_tasks, n_episodes), got {array.shape}")
    if len(own) != len(other):
        raise InputError(f"expert must have a curve for each of {len(own)} tasks, got {len(other)}")
    least = min(own.shape[1], other.shape[1])
    return (own[:, :least], other[:, :least]) if cut else (own, other)
