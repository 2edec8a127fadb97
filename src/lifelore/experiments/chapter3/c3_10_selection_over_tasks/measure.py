"""Measures and rows of claim C3.10."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter3.c3_10_selection_over_tasks.run import SERIES, mask_of
from lifelore.experiments.chapter3.modified_factory_tasks import CARDINALS, FULL_SET
from lifelore.experiments.engine.estimates import exact_share

GOAL = mask_of(CARDINALS)


def _masks(results: Sequence[Mapping], series: str) -> np.ndarray:
    """(n_runs, n_tasks) chosen sets as bit masks."""
    return np.array([result["chosen"][series] for result in results], np.int64)


def shares(masks: np.ndarray) -> np.ndarray:
    """(10, n_tasks) share of runs in which each feature is chosen, from (n_runs, n_tasks) masks."""
    bits = masks[:, :, None] >> np.arange(len(FULL_SET)) & 1
    return bits.mean(axis=0).T


def settled_after(masks: np.ndarray) -> list[int]:
    """Tasks of each run after which the set is φ2 to the end; one more than there are where it is not."""
    n_tasks = masks.shape[1]
    return [n_tasks + 1 if run[-1] != GOAL else 1 + _last_other(run) for run in masks]


def _last_other(run: np.ndarray) -> int:
    """How many tasks there are up to the last after which the set was another; 0 if it never was."""
    others = np.flatnonzero(run != GOAL)
    return int(others[-1]) + 1 if others.size else 0


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Which features each series ends with, and in how many runs it has come to rest at φ2."""
    measured = {}
    for series in SERIES:
        masks, name = _masks(results, series), name_of(series)
        of_feature = dict(zip(FULL_SET.names, shares(masks)[:, -1], strict=True))
        for group, pick in (("least_share_of_four", min), ("largest_share_of_others", max)):
            wanted = group.endswith("four")
            feature = pick((f for f in FULL_SET.names if (f in CARDINALS) == wanted), key=lambda f: of_feature[f])
            bit = masks[:, -1] >> FULL_SET.names.index(feature) & 1
            measured[f"{name}_{group}"] = exact_share(bit.tolist())
        measured[f"{name}_settled_share"] = exact_share(
            (masks[:, -settings["last"] :] == GOAL).all(axis=1).tolist()
        )
        measured[f"{name}_exactly_phi2"] = exact_share((masks[:, -1] == GOAL).tolist())
        measured[f"{name}_settled_after"] = mean_estimate(settled_after(masks))
        chosen = [int(mask).bit_count() for mask in masks[:, -1]]
        measured[f"{name}_features_chosen"] = mean_estimate(chosen)
    return measured


def name_of(series: str) -> str:
    """A series in the name of a measure."""
    return series.replace(",", "").replace(" ", "_")


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a series: the share of runs with each feature after each task."""
    kept = []
    for series, how in SERIES.items():
        of_feature = dict(zip(FULL_SET.names, np.round(shares(_masks(results, series)), 4).tolist(), strict=True))
        kept.append({"series": series, "over": how.counting.over, "shares": of_feature})
    return kept
