"""Measures and rows of claim C4.12."""

from collections.abc import Mapping, Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter4.ball_game_settings import N_TYPES, Setting
from lifelore.experiments.chapter4.c4_12_user_diversity.run import DIVERSITIES
from lifelore.experiments.chapter4.diversity_runs import (
    HINDSIGHT,
    METHODS,
    ORACLE,
    PRINTED_EXP3,
    STATIC,
    TUNED_EXP3,
)

BEAT, PRINTED = "BEAT", "BEAT, ε as printed"
FEW, MANY = 3, 4
"""Types up to which the thesis finds the best static speed better, and from which BEAT."""


def _losses(results: Sequence[Mapping], game: Sequence) -> dict[int, dict[str, NDArray[np.float64]]]:
    """Mean loss of each run, by diversity and method."""
    mine = [r for r in results if r["game"] == list(game)]
    return {r["diversity"]: {m: np.array(r["losses"][m]) for m in METHODS} for r in mine}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of the first game by diversity, and over the grid; something is so where its interval leaves no doubt."""
    by = _losses(results, settings["games"][0])
    found: dict[str, Estimate] = {}
    for x in DIVERSITIES:
        for method, key in ((STATIC, "static"), (PRINTED, "beat_printed"), (BEAT, "beat"), (PRINTED_EXP3, "exp3")):
            found[f"loss_{key}_{x}"] = mean_estimate(by[x][method])
        found[f"printed_less_static_{x}"] = mean_estimate(by[x][PRINTED] - by[x][STATIC])
        found[f"beat_less_static_{x}"] = mean_estimate(by[x][BEAT] - by[x][STATIC])
        for other, key in ((PRINTED_EXP3, "exp3"), (TUNED_EXP3, "tuned_exp3")):
            found[f"printed_to_{key}_{x}"] = ratio_estimate(by[x][PRINTED], by[x][other])
            found[f"beat_to_{key}_{x}"] = ratio_estimate(by[x][BEAT], by[x][other])
    for key in ("printed", "beat"):
        for other in ("exp3", "tuned_exp3"):
            ratios = [found[f"{key}_to_{other}_{x}"] for x in DIVERSITIES]
            found[f"{key}_below_{other}"] = _share([_below(r, 1.0) for r in ratios])
            worst = max(ratios, key=lambda r: r.value)
            found[f"largest_{key}_to_{other}"] = worst
        for name, some in (("few", range(1, FEW + 1)), ("many", range(MANY, N_TYPES + 1))):
            gaps = [found[f"{key}_less_static_{x}"] for x in some]
            found[f"{key}_below_static_{name}"] = _share([_below(g, 0.0) for g in gaps])
            found[f"{key}_above_static_{name}"] = _share([_above(g, 0.0) for g in gaps])
    found["beat_below_static_from_3"] = _share([_below(found[f"beat_less_static_{x}"], 0.0) for x in range(3, 7)])
    found["beat_to_oracle"] = ratio_estimate(*(_all(by, m) for m in (BEAT, ORACLE)))
    found["beat_to_hindsight"] = ratio_estimate(*(_all(by, m) for m in (BEAT, HINDSIGHT)))
    grid = [_losses(results, game) for game in settings["games"]]
    below = [_below(ratio_estimate(_all(g, PRINTED), _all(g, PRINTED_EXP3)), 1.0) for g in grid]
    found["grid_below_exp3"] = _share(below)
    found["grid_below_static_at_6"] = _share([_below(mean_estimate(g[6][BEAT] - g[6][STATIC]), 0.0) for g in grid])
    return found


def _all(by: Mapping[int, Mapping[str, NDArray]], method: str) -> NDArray[np.float64]:
    """Mean loss in each population, (63,)."""
    return np.concatenate([by[x][method].reshape(comb(N_TYPES, x), -1).mean(axis=1) for x in sorted(by)])


def _below(number: Estimate, bound: float) -> bool:
    return number.ci95 is not None and number.ci95[1] < bound


def _above(number: Estimate, bound: float) -> bool:
    return number.ci95 is not None and number.ci95[0] > bound


def _share(answers: Sequence[bool]) -> Estimate:
    return Estimate(float(np.mean(answers)), float(np.median(answers)), None, len(answers))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean loss by game, diversity and method, with half of its 95 % interval."""
    found = []
    for result in results:
        row = {key: result[key] for key in ("game", "diversity", "populations", "gamma", "best")}
        lost = {m: np.array(v) for m, v in result["losses"].items()}
        row["words"], row["n"] = Setting(*result["game"]).words, len(lost[STATIC])
        row["loss"] = {m: round(float(v.mean()), 4) for m, v in lost.items()}
        strata = comb(N_TYPES, result["diversity"]) * result["diversity"]
        row["error"] = {m: _half_width(v.reshape(strata, -1)) for m, v in lost.items()}
        found.append(row)
    return found


def _half_width(lost: NDArray[np.float64]) -> float:
    """Of the 95 % interval of the mean of strata (types of a population), all of one size."""
    return round(float(1.96 * np.sqrt(lost.var(axis=1).mean() / lost.size)), 4)
