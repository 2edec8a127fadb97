"""C4.2: errors of greedy selection by shot, its gain over a single club, and the fall of the belief's entropy."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter4.c4_02_golf_holes.run import GREEDY
from reproduction.chapter4.golf.rounds import WOOD
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN
from reproduction.engine.estimates import exact_share, is_above, is_below, share_of
from reproduction.engine.results_table import ResultsTable

NEAR = 15.0
"""Yards: the far end of "10–15"."""
GIVEN = "exact models; the hole is one of the four training holes, each as likely"


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of each kind of model the means over groups of holes."""
    table = ResultsTable(results, ("part", "model", "rule", "first"))
    single, best = (table.values(key, part="clubs")[0] for key in ("club", "best"))
    single = single[:, single.mean(axis=0).argmin()]
    measured = {}
    for model in (LEARNT, EXACT, UNCERTAIN):
        greedy = {"model": model, "rule": GREEDY, "first": None}
        error, entropy = (table.values(key, **greedy)[0] for key in ("error", "entropy"))
        wood = table.values("error", **{**greedy, "first": WOOD})[0]
        measured |= {
            f"error_shot_2_{model}": mean_estimate(error[:, 1]),
            f"error_shot_2_wood_first_{model}": mean_estimate(wood[:, 1]),
            f"groups_within_15_{model}": exact_share(error[:, 1] <= NEAR),
            f"gain_over_best_single_club_{model}": mean_estimate(single - error[:, 1]),
            f"more_than_best_club_{model}": mean_estimate(error[:, 1] - best),
            f"entropy_fall_first_{model}": mean_estimate(entropy[:, 0] - entropy[:, 1]),
            f"entropy_fall_later_{model}": mean_estimate(entropy[:, 1] - entropy[:, -1]),
        }
    within = [
        is_below(measured[f"error_shot_2_{way}"], NEAR)
        and is_above(measured[f"entropy_fall_first_{way.removeprefix('wood_first_')}"], 0.0)
        for model in (LEARNT, EXACT, UNCERTAIN)
        for way in (model, f"wood_first_{model}")
    ]
    return measured | {"grid_within_15": share_of(within)}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Curves of every rule, single clubs, and the program's values."""
    found = []
    for result in results:
        row = {key: value for key, value in result.items() if key in ("part", "model", "rule", "first")}
        if result["part"] == "program":
            found += [{**row, "way": name, "given": GIVEN, **way} for name, way in result["found"].items()]
            continue
        for key in ("error", "entropy", "club", "best"):
            if key in result:
                of_groups = np.array(result[key], float)
                row[key] = of_groups.mean(axis=0).round(4).tolist()
                if key == "error":
                    row["worst_groups"] = np.quantile(of_groups, 0.95, axis=0).round(3).tolist()
        found.append(row)
    return found
