"""C4.12: BEAT against EXP-3 and the best static speed, by the diversity of the population.

The best static speed is the population's in training (Eq. 4.8); BEAT and EXP-3 are not told the population. The
default game was chosen by what it shows (`ball_game_settings`); the grid says how far that goes.
Thesis: §4.8.5.2, Figure 4.16.
"""

from collections.abc import Mapping, Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter4.ball_game_settings import GAMES, N_TYPES, Setting, check_games
from lifelore.experiments.chapter4.diversity_runs import (
    HINDSIGHT,
    METHODS,
    ORACLE,
    PRINTED_EXP3,
    STATIC,
    TUNED_EXP3,
    run_cell,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate

FULL = {"games": GAMES, "runs": 120, "least": 600, "grid_runs": 40, "training": 200, "tuning": 100}
QUICK = {"games": GAMES[:2], "runs": 2, "least": 6, "grid_runs": 2, "training": 10, "tuning": 2}
BEAT, PRINTED = "BEAT", "BEAT, ε as printed"
DIVERSITIES = range(1, N_TYPES + 1)
FEW, MANY = 3, 4
"""Types up to which the thesis finds the best static speed better, and from which BEAT."""
CAUSES = {
    "few favour static": "BEAT identifies the types that matter within its first episode, so that little is lost "
    "by not knowing the population",
    "below EXP-3 on the grid": "where one speed is good enough for all, little is lost by choosing at random; the "
    "default, in which a ball that is blocked slides, was chosen after a game in which it stays had shown BEAT no "
    "better than EXP-3, and the grid has such games",
}


def _check(settings: Mapping) -> None:
    check_games(settings, ("runs", "least", "grid_runs", "training", "tuning"))
    if settings["training"] < 2:
        raise InputError(f"training must be at least 2 episodes, got {settings['training']}")


def cells(settings: Mapping) -> list[dict]:
    """One a game and diversity; the first game gets `runs` a population and at least `least` a diversity."""
    found = []
    for place, game in enumerate(settings["games"]):
        for diversity in DIVERSITIES:
            least = -(-settings["least"] // comb(N_TYPES, diversity))
            runs = settings["grid_runs"] if place else max(settings["runs"], least)
            found.append({"game": list(game), "diversity": diversity, "runs": runs})
    return found


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.population_diversity import draw_population_diversity

    return draw_population_diversity(result)


CLAIM = Claim(
    id="C4.12",
    title="BEAT by the diversity of its users (Figure 4.16)",
    thesis="Averaged across population sizes, BEAT outperforms EXP-3 significantly; for smaller populations (1–3) "
    "the best static speed is marginally better than BEAT, for larger ones BEAT outperforms it comprehensively "
    "(5 episodes, 100 runs, k = 1, ε = 0.5 less 0.1 an episode).",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.12"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
