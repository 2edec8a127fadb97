"""C4.1: entropies of the belief beside the printed ones, and how often rounds go as printed."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter4.golf.rounds import WOOD
from reproduction.engine.estimates import exact_share, exact_value
from reproduction.engine.results_table import ResultsTable

PRINTED_ENTROPY = (1.3863, 0.2237, 0.0)
"""Before the first three shots, nats."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    table = ResultsTable(results, ("part", "first"))
    printed = table.record(part="printed")
    measured = {f"entropy_{k + 1}": exact_value(printed["entropy"][k]) for k in range(len(PRINTED_ENTROPY))}
    measured["first_is_wood"] = exact_value(printed["first_club"][WOOD])
    measured["irons_after_printed"] = exact_value(np.mean(printed["iron"]))
    for first, name in ((None, "greedy"), (WOOD, "wood")):
        played = table.record(part="played", first=first)
        for after in ("first", "second"):
            answers = np.arange(settings["rounds"]) < played[f"iron_after_{after}"]
            measured[f"iron_after_{after}_{name}"] = exact_share(answers)
    for learnt in table.select(part="learnt").records:
        name = f"{learnt['samples']}_{learnt['pseudo_count']:g}"
        above = np.array(learnt["entropy"])[:, 0] > PRINTED_ENTROPY[1]
        measured[f"share_above_printed_{name}"] = exact_share(above)
        measured[f"irons_learnt_{name}"] = mean_estimate(learnt["irons"])
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The parts; of learnt models the quantiles of the entropies after the first two shots."""
    found = []
    for result in results:
        row = {key: value for key, value in result.items() if key not in ("entropy", "irons")}
        if result["part"] == "learnt":
            quantiles = np.quantile(result["entropy"], [0.025, 0.25, 0.5, 0.75, 0.975], axis=0)
            row["entropy_quantiles"] = quantiles.round(5).T.tolist()
        else:
            row["entropy"] = [round(h, 5) for h in result["entropy"]]
        found.append(row)
    return found
