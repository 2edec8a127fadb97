"""Measures and rows of claim C4.13."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.experiments.chapter4.ball_game_settings import Setting
from lifelore.experiments.chapter4.type_naming import WAYS

LARGE = 3
"""Number of the first of the sizes 20, 40 and 60."""


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
    """Of the first game: shares right half-way through the first episode, at step 40 and at the ends."""
    every = range(len(SIZES))
    found: dict[str, Estimate] = {}
    for result in results[: len(WAYS)]:
        key = {"BEAT": "", "BEAT, ε as printed": "_printed", "BEAT with commands": "_with_commands"}[result["way"]]
        for when in ("half", "at_40", "first", "last"):
            found[f"right_{when}{key}"] = right_of(result[when], every)
            found[f"right_{when}_large{key}"] = right_of(result[when], range(LARGE, len(SIZES)))
        found.update({f"right_half_b{SIZES[i]}{key}": right_of(result["half"], [i]) for i in every})
        found.update({f"right_at_40_b{SIZES[i]}{key}": right_of(result["at_40"], [i]) for i in every})
    half = np.array(results[0]["half"])
    others = [found[f"right_half_b{b}"].value for b in SIZES[1:]]
    found["least_right_half_but_smallest"] = min(
        (found[f"right_half_b{b}"] for b in SIZES[1:]), key=lambda e: e.value
    )
    worst = found["right_half_b2"].value - min(others)
    found["smallest_above_worst"] = Estimate(worst, worst, None, len(others))
    mixed = half[0, 1] + half[1, 0]
    apart = np.triu(half + half.T, 1)
    found["two_and_five_confused"] = share(mixed, half[:2].sum())
    found["two_and_five_of_confusions"] = share(mixed, max(apart.sum(), 1))
    pairs = np.sort(apart[np.triu_indices(len(SIZES), 1)])
    rank = float((pairs > mixed).sum())
    found["pairs_confused_more_often"] = Estimate(rank, rank, None, len(pairs))
    grid = [right_of(r["half"], range(LARGE, len(SIZES))).value for r in results if r["way"] == "BEAT"]
    found["grid_right_half_large"] = Estimate(float(np.mean(grid)), float(np.median(grid)), None, len(grid))
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Share right and mean ratio of sizes by step and type; confusions."""
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
