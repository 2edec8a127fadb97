"""Measures and rows of claim C3.10."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter3.c3_10_selection_over_tasks.run import SERIES, mask_of
from reproduction.chapter3.factory.modified_tasks import CARDINALS, FULL_SET
from reproduction.engine.estimates import exact_share, is_above, share_of

GOAL = mask_of(CARDINALS)
NEARLY_ALL = 0.8
"""Share of the runs above which, for certain, a set counts as the one that the selection converges to."""


def _masks(results: Sequence[Mapping], series: str) -> np.ndarray:
    """(n_runs, n_tasks) chosen sets as bit masks."""
    return np.array([result["chosen"][series] for result in results], np.int64)


def shares(masks: np.ndarray) -> np.ndarray:
    """(10, n_tasks) share of runs in which each feature is chosen, from (n_runs, n_tasks) masks."""
    bits = masks[:, :, None] >> np.arange(len(FULL_SET)) & 1
    return bits.mean(axis=0).T


def settled_after(masks: np.ndarray) -> list[int]:
    """Number of tasks of each run after which the set is φ2 to the end; n_tasks + 1 where it never is."""
    return [1 + max((np.flatnonzero(run != GOAL) + 1).tolist(), default=0) for run in masks]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The features that each series ends with, and in how many runs it has settled at φ2."""
    measured, converged = {}, []
    for series in SERIES:
        masks, name = _masks(results, series), series.replace(",", "").replace(" ", "_")
        of_feature = dict(zip(FULL_SET.names, shares(masks)[:, -1], strict=True))
        four = [feature for feature in FULL_SET.names if feature in CARDINALS]
        largest = max((f for f in FULL_SET.names if f not in CARDINALS), key=of_feature.__getitem__)
        least = min(four, key=of_feature.__getitem__)
        for group, feature in (("least_share_of_four", least), ("largest_share_of_others", largest)):
            chosen = masks[:, -1] >> FULL_SET.names.index(feature) & 1
            measured[f"{name}_{group}"] = exact_share(chosen.tolist())
        settled = (masks[:, -settings["last"] :] == GOAL).all(axis=1)
        measured[f"{name}_settled_share"] = exact_share(settled.tolist())
        measured[f"{name}_settled_after"] = mean_estimate(settled_after(masks))
        converged.append(is_above(measured[f"{name}_settled_share"], NEARLY_ALL))
    return {**measured, "grid_settled": share_of(converged)}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a series: the share of runs with each feature after each task."""
    return [
        {
            "series": series,
            "over": use.counting.over,
            "shares": dict(zip(FULL_SET.names, shares(_masks(results, series)).round(4).tolist(), strict=True)),
        }
        for series, use in SERIES.items()
    ]
