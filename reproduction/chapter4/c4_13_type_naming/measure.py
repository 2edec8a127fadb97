"""C4.13: shares of players whose type is named right half-way through the first episode, and who is confused."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.domains.ball_game.ball_game import SIZES
from reproduction.chapter4.ball_game.games import Setting
from reproduction.engine.estimates import exact_value

LARGE = range(3, len(SIZES))
"""Types of the sizes 20, 40 and 60."""


def share(right: float, n: float) -> Estimate:
    """A share with its 95 % interval (Wilson)."""
    from scipy.stats import binomtest

    value = right / n
    ends = binomtest(round(right), round(n)).proportion_ci(method="wilson")
    return Estimate(value, value, (float(ends.low), float(ends.high)), round(n))


def right_of(confusion: Sequence[Sequence[int]], types: Sequence[int]) -> Estimate:
    """Share of the players of `types` that were named right."""
    counts = np.array(confusion)[list(types)]
    return share(counts[range(len(types)), list(types)].sum(), counts.sum())


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares right and pairs confused in the first game, half-way through the first episode."""
    half = np.array(results[0]["half"])
    smallest, *others = (right_of(results[0]["half"], [i]) for i in range(len(SIZES)))
    least = min(others, key=lambda estimate: estimate.value)
    mixed = half + half.T
    pairs = mixed[np.triu_indices(len(SIZES), 1)]
    return {
        "right_half_large": right_of(results[0]["half"], LARGE),
        "least_right_half_but_smallest": least,
        "smallest_above_worst": exact_value(smallest.value - least.value, len(others)),
        "two_and_five_of_confusions": share(mixed[0, 1], max(pairs.sum(), 1)),
        "pairs_confused_more_often": exact_value((pairs > mixed[0, 1]).sum(), len(pairs)),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Confusions of every cell, and by step and type the share right and mean ratio of sizes in the first game."""
    found = []
    for result in results:
        row = {key: result[key] for key in ("game", "way", "half", "at_40", "first", "last")}
        row["words"] = Setting(*result["game"]).words
        row["median_length"] = float(np.median(result["lengths"]))
        if result["game"] == list(settings["games"][0]):
            row["right"] = np.round(result["right"], 3).tolist()
            row["ratio"] = np.round(result["ratio"], 3).tolist()
        found.append(row)
    return found
