"""C3.10: features chosen online over thirty tasks of the modified factory, from exact and from learnt policies.

The thesis runs Alg. 6 on learnt policies and does not say which states of one count. By default those count where
something was tried; beside it only those that promise a reward, all there are, longer learning, and uniform
exploration. By the printed rewards the best of a state is often worth less than nothing, so that to ask for a
promise leaves out much that is right. Exact policies count in every state; beside it only on an optimal way.

Thesis: §3.4.6, Figure 3.14.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter3.c3_07_feature_sets.run import check_components
from lifelore.experiments.chapter3.c3_10_selection_over_tasks.selected_features import (
    SERIES,
    cells,
    mask_of,
    run_cell,
)
from lifelore.experiments.chapter3.modified_factory_tasks import CARDINALS, FULL_SET
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share
from lifelore.experiments.engine.learning_settings import check_among, check_counts, check_learning
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "discount": 0.99,
    "components": 4,
    "runs": 30,
    "tasks": 30,
    "last": 5,
    "episodes": 100,
    "long_episodes": 500,
    "max_steps": 2000,
    "learning_rate": 0.5,
    "schedule": [1.0, 0.95, 0.01],
    "ties": "uniform",
    "alpha0": 0.1,
}
QUICK = {
    **FULL,
    "components": 1,
    "runs": 3,
    "tasks": 4,
    "last": 2,
    "episodes": 10,
    "long_episodes": 20,
    "max_steps": 300,
}
GOAL = mask_of(CARDINALS)


def _check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "tasks", "last", "episodes", "long_episodes", "max_steps", "components"))
    check_learning({**settings, "schedules": [settings["schedule"]]})
    check_among({"ties": [settings["ties"]]}, "ties", TIES)
    check_components(settings)
    if settings["last"] > settings["tasks"]:
        raise InputError(f"last must be at most tasks ({settings['tasks']}), got {settings['last']}")
    if settings["alpha0"] <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_10_selection_over_tasks.figure_feature_shares import draw_feature_shares

    return draw_feature_shares(result)


CLAIM = Claim(
    id="C3.10",
    title="Features selected online over 30 tasks (Figure 3.14)",
    thesis="In the modified factory, over 30 tasks and 10 runs, online feature selection (Alg. 6) converges to "
    "the four features of φ2: the cells to the North, South, East and West.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.10"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    check=_check,
)
