"""C5.5: points missed after spare time, spare orders that equal competence needs, and the late type."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from lifelore.core.streams import stream
from reproduction.chapter5.c5_05_curiosity.late_type import SOON, LateTypeLife, auc
from reproduction.chapter5.c5_05_curiosity.run import CHOOSERS, UNIFORM, late_lives
from reproduction.engine.estimates import UNMEASURED, exact_share

RESAMPLES = 1000
"""Resamples of an interval; more costs time, not accuracy."""
GAIN = 0.8
"""Share of what uniform replay gains, at which episodes are compared."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Means over lives, paired differences and ratios."""
    missed = curves(results)
    found = {"missed_before": mean_estimate(missed[UNIFORM][:, 0])}
    for chooser in CHOOSERS:
        found[f"missed_{chooser}"] = mean_estimate(missed[chooser][:, -1])
    for chooser in CHOOSERS[1:]:
        found[f"{chooser}_less_uniform"] = difference_estimate(missed[chooser][:, -1], missed[UNIFORM][:, -1])
        needed = [
            [orders_needed(settings, own, goal) for own, goal in zip(missed[name], goals(missed), strict=True)]
            for name in (chooser, UNIFORM)
        ]
        found[f"{chooser}_over_uniform_episodes"] = ratio_estimate(*needed)
    lives = late_lives(list(results))
    found["late_type_auc"] = auc_over_lives(lives)
    found["late_type_learnt"] = exact_share(life.learnt for life in lives)
    false = [float(np.mean(life.false_alarms)) for life in lives if life.false_alarms]
    found["false_alarms"] = mean_estimate(false) if false else UNMEASURED
    again = ((life.recognised_after or np.inf) <= SOON for life in lives if life.again)
    found["recognised_soon"] = exact_share(again)
    return found


def auc_over_lives(lives: Sequence[LateTypeLife]) -> Estimate:
    """The area under the curve of all lives' scores; its interval resamples lives (percentiles)."""

    def of(some: Sequence[LateTypeLife]) -> float:
        known = [score for life in some for score in life.known_scores]
        return auc(known, [score for life in some for score in life.late_scores]) if known else np.nan

    if not any(life.known_scores for life in lives):
        return UNMEASURED
    draws = stream(len(lives), "lives resampled").integers(len(lives), size=(RESAMPLES, len(lives)))
    found = [of([lives[place] for place in draw]) for draw in draws]
    low, high = np.nanquantile(found, [0.025, 0.975])
    return Estimate(of(lives), float(np.nanmedian(found)), (float(low), float(high)), len(lives))


def curves(results: Sequence[Mapping]) -> dict[str, NDArray[np.float64]]:
    """Points missed after each span of spare orders, (n_lives, n_spans + 1), by chooser."""
    return {name: np.array([one[name] for one in results if name in one]) for name in CHOOSERS}


def goals(missed: Mapping[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """(n_lives,) points missed at `GAIN` of what uniform replay gains; those of the start, if it gains nothing."""
    start, end = missed[UNIFORM][:, 0], missed[UNIFORM][:, -1]
    return start - GAIN * np.maximum(start - end, 0.0)


def orders_needed(settings: Mapping, missed: NDArray[np.float64], goal: float) -> float:
    """Spare orders until no more than `goal` is missed, between spans by a straight line; all, if never."""
    reached = np.flatnonzero(missed <= goal)
    if not len(reached):
        return float(settings["spare"])
    last = int(reached[0])
    if last == 0:
        return 0.0
    above, below = missed[last - 1], missed[last]
    return float(settings["every"] * (last - 1 + (above - goal) / (above - below)))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a chooser: mean over lives after each span of spare orders, with its standard error."""
    found = []
    for chooser, missed in curves(results).items():
        n = len(missed)
        error = missed.std(axis=0, ddof=1) / n**0.5 if n > 1 else np.zeros(missed.shape[1])
        found.append(
            {"chooser": chooser, "mean": missed.mean(axis=0).round(3).tolist(), "error": error.round(3).tolist()}
        )  # fmt: skip
    return found
