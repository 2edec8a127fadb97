"""Measures and rows of claim C4.1."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.golf_runs import WOOD
from lifelore.experiments.engine.estimates import exact_share

PRINTED_ENTROPY = (1.3863, 0.2237, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
HALF_DIGIT = 0.00005


def _part(results: Sequence[Mapping], **wanted) -> Mapping:
    return next(r for r in results if all(r.get(key) == value for key, value in wanted.items()))


def known(value: float) -> Estimate:
    """A number that no sampling stands behind."""
    return Estimate(value, value, None, 1)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The printed table's numbers from exact models, from learnt ones, and how often rounds go that way."""
    printed = _part(results, part="printed")
    measured = {
        "entropy_1": known(printed["entropy"][0]),
        "entropy_2": known(printed["entropy"][1]),
        "entropy_3": known(printed["entropy"][2]),
        "first_is_wood": known(printed["first_club"][WOOD]),
        "irons_after_printed": known(float(np.mean(printed["iron"]))),
    }
    for first, name in ((None, "greedy"), (WOOD, "wood")):
        played = _part(results, part="played", first=first)
        for after in ("first", "second"):
            right = played[f"iron_after_{after}"]
            answers = np.arange(settings["rounds"]) < right
            measured[f"iron_after_{after}_{name}"] = exact_share(answers.tolist())
    for learnt in results:
        if learnt["part"] == "learnt":
            name = f"{learnt['samples']}_{learnt['pseudo_count']:g}"
            after = np.array(learnt["entropy"])
            measured[f"entropy_2_learnt_{name}"] = mean_estimate(after[:, 0])
            measured[f"share_above_printed_{name}"] = exact_share((after[:, 0] > PRINTED_ENTROPY[1]).tolist())
            measured[f"share_settled_third_{name}"] = exact_share((after[:, 1] < HALF_DIGIT).tolist())
            measured[f"irons_learnt_{name}"] = mean_estimate(learnt["irons"])
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The parts; of learnt models the quantiles of the entropies after one and two shots."""
    kept = []
    for result in results:
        row = {key: value for key, value in result.items() if key not in ("entropy", "irons")}
        if result["part"] == "learnt":
            quantiles = np.quantile(np.array(result["entropy"]), [0.025, 0.25, 0.5, 0.75, 0.975], axis=0)
            row["entropy_quantiles"] = quantiles.round(5).T.tolist()
        else:
            row["entropy"] = [round(h, 5) for h in result["entropy"]]
        kept.append(row)
    return kept
