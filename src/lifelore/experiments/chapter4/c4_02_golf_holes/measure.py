"""Measures and rows of claim C4.2."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_02_golf_holes.golf_programs import GIVEN
from lifelore.experiments.chapter4.c4_02_golf_holes.run import GREEDY
from lifelore.experiments.chapter4.golf_runs import EXACT, LEARNT, WOOD
from lifelore.experiments.engine.estimates import exact_share

NEAR = 15.0
"""Yards: the far end of "10–15"."""


def _of(results: Sequence[Mapping], key: str, **wanted) -> np.ndarray:
    """The numbers `key` of the one cell that has all of `wanted`, a row a group."""
    return np.array(next(r[key] for r in results if all(r.get(k) == v for k, v in wanted.items())), float)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Greedy selection by model, what it gains over one club, and each rule's gap to the program."""
    measured = {}
    clubs, best = _of(results, "club", part="clubs"), _of(results, "best", part="clubs")
    for model in (LEARNT, EXACT):
        error = _of(results, "error", model=model, rule=GREEDY, first=None)
        entropy = _of(results, "entropy", model=model, rule=GREEDY, first=None)
        wood = _of(results, "error", model=model, rule=GREEDY, first=WOOD)
        measured |= {
            f"error_shot_1_{model}": mean_estimate(error[:, 0]),
            f"error_shot_2_{model}": mean_estimate(error[:, 1]),
            f"error_last_{model}": mean_estimate(error[:, -1]),
            f"error_shot_2_wood_first_{model}": mean_estimate(wood[:, 1]),
            f"groups_within_15_{model}": exact_share((error[:, 1] <= NEAR).tolist()),
            f"gain_over_best_single_club_{model}": mean_estimate(
                clubs[:, clubs.mean(axis=0).argmin()] - error[:, 1]
            ),
            f"more_than_best_club_{model}": mean_estimate(error[:, 1] - best),
            f"entropy_fall_first_{model}": mean_estimate(entropy[:, 0] - entropy[:, 1]),
            f"entropy_fall_later_{model}": mean_estimate(entropy[:, 1] - entropy[:, -1]),
        }
    for name, way in next(r["found"] for r in results if r["part"] == "program").items():
        measured[f"gap_{name.replace(' ', '_').replace(',', '')}"] = Estimate(way["gap"], way["gap"], None, 1)
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Curves of every rule, single clubs, and the program's values."""
    kept = []
    for result in results:
        row = {key: value for key, value in result.items() if key in ("part", "model", "rule", "first")}
        if result["part"] == "program":
            kept += [{**row, "way": name, "given": GIVEN, **way} for name, way in result["found"].items()]
            continue
        for key in ("error", "entropy", "club", "best"):
            if key in result:
                of_groups = np.array(result[key], float)
                row[key] = of_groups.mean(axis=0).round(4).tolist()
                if key == "error":
                    row["worst_groups"] = np.quantile(of_groups, 0.95, axis=0).round(3).tolist()
        kept.append(row)
    return kept
