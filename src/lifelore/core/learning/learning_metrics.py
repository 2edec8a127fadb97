"""The five measures of transfer between two sets of learning curves, paired run by run.

A curve is the performance of each episode, larger is better. Curves of many runs are (n_runs, n_episodes); row i
of a learner and row i of its baseline are the same task on the same random streams. The measures are those of
Taylor & Stone, Transfer Learning for Reinforcement Learning Domains, JMLR 10 (2009), §2.1.
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, difference_estimate, ratio_estimate

LAST_SHARE = 0.1
"""Share of the episodes, the last ones, whose mean stands for the asymptote."""


def jumpstart(returns: ArrayLike, baseline: ArrayLike) -> Estimate:
    """First-episode advantage: mean paired difference of first returns (n_runs,)."""
    return difference_estimate(returns, baseline)


def episodes_to_threshold(returns: NDArray[np.float64], threshold: float, window: int = 1) -> int | None:
    """Episodes until the moving mean over `window` first reaches `threshold`; None if it never does.

    The count is of episodes run, so at least `window`.
    """
    returns = np.asarray(returns, float)
    if window < 1 or window > len(returns):
        raise InputError(f"window must lie in [1, {len(returns)}], got {window}")
    # Summed, then divided: the mean of ten returns of 1 is exactly 1.
    smooth = np.convolve(returns, np.ones(window), mode="valid") / window
    reached = np.flatnonzero(smooth >= threshold)
    return int(reached[0]) + window if reached.size else None


@dataclass(frozen=True)
class LearningGain:
    """A learner compared with its baseline over the same runs; see `learning_gain`.

    jumpstart : difference of first performances
    asymptote : difference of the mean performances of the last episodes
    total_reward : difference of the areas under the curves
    transfer_ratio : (area with transfer − area without) / area without, of means over runs: 0 no transfer, 1 twice
        the reward. None where the baseline has a run without area above the floor.
    threshold_ratio : episodes to the threshold over the baseline's; below 1 is faster
    threshold_saved : further episodes to the threshold that the baseline needs
    never, baseline_never : runs that never reached the threshold; they count as all their episodes
    """

    jumpstart: Estimate
    asymptote: Estimate
    total_reward: Estimate
    transfer_ratio: Estimate | None
    threshold_ratio: Estimate
    threshold_saved: Estimate
    never: int
    baseline_never: int

    def to_dict(self) -> dict:
        """Plain data."""
        plain = {field.name: getattr(self, field.name) for field in fields(self)}
        return {k: v.to_dict() if isinstance(v, Estimate) else v for k, v in plain.items()}


def learning_gain(
    curves: ArrayLike,
    baseline: ArrayLike,
    threshold: ArrayLike,
    *,
    window: int = 1,
    share: float = LAST_SHARE,
    floor: float = 0.0,
) -> LearningGain:
    """All five measures of transfer, paired run by run, with 95 % intervals.

    Parameters
    ----------
    curves, baseline : (n_runs, n_episodes) float
        Performance of the learner with a past, and of the one without.
    threshold : float or (n_runs,) float
        Performance at which a run counts as learnt, such as 0.8 of its optimum.
    window : int
        Episodes of the moving mean that must reach the threshold.
    share : float
        Share of the episodes, the last ones, whose mean stands for the asymptote, in (0, 1]; at least one.
    floor : float
        The performance that counts as 0 in the transfer ratio, which depends on it.

    Examples
    --------
    >>> gain = learning_gain([[1, 2, 4], [2, 3, 4]], [[0, 1, 4], [0, 2, 4]], threshold=2)
    >>> gain.jumpstart.value, gain.asymptote.value, round(gain.transfer_ratio.value, 3), gain.threshold_saved.value
    (1.5, 0.0, 0.455, 1.0)
    """
    curves, baseline = _paired(curves, baseline)
    thresholds = np.asarray(threshold, float)
    if thresholds.shape not in ((), (len(curves),)):
        raise InputError(f"threshold must be one number or one a run ({len(curves)}), got {thresholds.shape}")
    if not (np.isfinite(thresholds).all() and np.isfinite(floor)):
        raise InputError(f"threshold and floor must be finite, got {threshold} and {floor}")
    if not 0 < share <= 1:
        raise InputError(f"share must lie in (0, 1], got {share}")
    own, never = _times(curves, thresholds, window)
    other, other_never = _times(baseline, thresholds, window)
    last = slice(-max(1, round(share * curves.shape[1])), None)
    area, without = (curves - floor).sum(axis=1), (baseline - floor).sum(axis=1)
    return LearningGain(
        jumpstart=jumpstart(curves[:, 0], baseline[:, 0]),
        asymptote=difference_estimate(curves[:, last].mean(axis=1), baseline[:, last].mean(axis=1)),
        total_reward=difference_estimate(curves.sum(axis=1), baseline.sum(axis=1)),
        transfer_ratio=ratio_estimate(area - without, without) if (without > 0).all() else None,
        threshold_ratio=ratio_estimate(own, other),
        threshold_saved=difference_estimate(other, own),
        never=never,
        baseline_never=other_never,
    )


def _times(curves: NDArray[np.float64], thresholds: NDArray[np.float64], window: int) -> tuple[list[int], int]:
    """Episodes to the threshold of each run, all of them where it is never met; and how many never met it."""
    each = np.broadcast_to(thresholds, len(curves))
    times = [episodes_to_threshold(c, float(t), window) for c, t in zip(curves, each, strict=True)]
    return [curves.shape[1] if time is None else time for time in times], times.count(None)


def _paired(curves: ArrayLike, baseline: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    own, other = np.asarray(curves, np.float64), np.asarray(baseline, np.float64)
    for name, array in (("curves", own), ("baseline", other)):
        if array.ndim != 2 or not array.size or not np.isfinite(array).all():
            raise InputError(
                f"{name} must be finite and (n_runs, n_episodes), at least one of each, got {array.shape}"
            )
    if own.shape != other.shape:
        raise InputError(f"curves and baseline must agree run by run, got {own.shape} and {other.shape}")
    return own, other
