"""C4.12: at how many diversities, and in how many games, BEAT loses less than EXP-3 and the best static speed."""

from collections.abc import Mapping, Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter4.ball_game import methods
from reproduction.chapter4.ball_game.games import N_TYPES, Setting
from reproduction.chapter4.ball_game.methods import BEAT, PRINTED_EXP3, STATIC, TUNED_EXP3
from reproduction.chapter4.ball_game.methods import BEAT_PRINTED as PRINTED
from reproduction.chapter4.c4_12_user_diversity.run import DIVERSITIES
from reproduction.engine.estimates import is_above, is_below, share_of

FEW, MANY = range(1, 4), range(4, N_TYPES + 1)
"""Numbers of types for which the thesis finds the best static speed better, and for which BEAT."""


def _losses(results: Sequence[Mapping], game: Sequence) -> dict[int, dict[str, NDArray[np.float64]]]:
    """Mean loss of each run of a game, by diversity and method."""
    own = [r for r in results if r["game"] == list(game)]
    return {r["diversity"]: {m: np.array(r["losses"][m]) for m in methods.METHODS} for r in own}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Comparisons in the first game and over the grid; a method is below another if the whole interval is."""
    grid = [_losses(results, game) for game in settings["games"]]
    by = grid[0]
    found: dict[str, Estimate] = {}
    for key, method in (("printed", PRINTED), ("beat", BEAT)):
        for other, name in (("exp3", PRINTED_EXP3), ("tuned_exp3", TUNED_EXP3)):
            ratios = [ratio_estimate(by[x][method], by[x][name]) for x in DIVERSITIES]
            found[f"{key}_below_{other}"] = share_of([is_below(ratio, 1.0) for ratio in ratios])
            found[f"largest_{key}_to_{other}"] = max(ratios, key=lambda ratio: ratio.value)
        for some, diversities in (("few", FEW), ("many", MANY)):
            gaps = [mean_estimate(by[x][method] - by[x][STATIC]) for x in diversities]
            found[f"{key}_below_static_{some}"] = share_of([is_below(gap, 0.0) for gap in gaps])
            found[f"{key}_above_static_{some}"] = share_of([is_above(gap, 0.0) for gap in gaps])
    found["beat_to_oracle"] = _population_ratio(by, BEAT, methods.ORACLE)
    found["beat_to_hindsight"] = _population_ratio(by, BEAT, methods.HINDSIGHT)
    below = [is_below(_population_ratio(losses, PRINTED, PRINTED_EXP3), 1.0) for losses in grid]
    found |= dict(
        zip(("printed_to_exp3", "printed_to_static_few", "printed_to_static_many"), _sentence(by), strict=True)
    )
    sentences = [_sentence(losses) for losses in grid]
    certain = [is_below(exp3, 1.0) and is_above(few, 1.0) and is_below(many, 1.0) for exp3, few, many in sentences]
    return found | {"grid_below_exp3": share_of(below), "grid_sentence": share_of(certain)}


def _sentence(by: Mapping[int, Mapping[str, NDArray]]) -> tuple[Estimate, Estimate, Estimate]:
    """BEAT as printed to EXP-3 over all populations, and to the static speed over small and over large ones."""

    def some(diversities: range) -> dict[int, Mapping[str, NDArray]]:
        return {x: by[x] for x in diversities}

    few, many = (_population_ratio(some(sizes), PRINTED, STATIC) for sizes in (FEW, MANY))
    return _population_ratio(by, PRINTED, PRINTED_EXP3), few, many


def _population_ratio(by: Mapping[int, Mapping[str, NDArray]], *pair: str) -> Estimate:
    """Ratio of the losses of two methods, from the mean loss in each of the 63 populations."""

    def by_population(method: str) -> NDArray[np.float64]:
        return np.concatenate([by[x][method].reshape(comb(N_TYPES, x), -1).mean(axis=1) for x in sorted(by)])

    return ratio_estimate(*map(by_population, pair))


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
    """Half of the 95 % interval of the mean over strata (types of a population), all of one size."""
    return round(float(1.96 * np.sqrt(lost.var(axis=1).mean() / lost.size)), 4)
