"""C4.15: BEAT's losses in the last episode, its regret, and how soon it names the type. Thesis: §4.8.5.2."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.metrics import Estimate, ratio_estimate
from reproduction.chapter4.ball_game import trials
from reproduction.chapter4.ball_game.games import check_games
from reproduction.chapter4.ball_game.trials import BEAT, BEAT_OURS, EXP3, ORACLE, STATIC
from reproduction.chapter4.c4_13_type_naming.run import numbers as naming

cells, check, run_cell, shared = trials.cells, check_games, trials.run_cell, trials.SHARED


def numbers(result: Mapping, instead: Mapping[str, str]) -> dict[str, Estimate]:
    """Ratios of losses and regrets, every size of the population weighing as much, paired by runs."""
    losses = {method: np.array(lost).mean(axis=0) for method, lost in result["losses"].items()}  # (runs, episodes)
    beat, exp3, static = (losses[instead.get(method, method)] for method in (BEAT, EXP3, STATIC))

    def regret_ratio(mine: np.ndarray) -> Estimate:
        return ratio_estimate(*((lost - losses[ORACLE]).sum(axis=1) for lost in (mine, exp3)))

    found = {
        "last_to_static": ratio_estimate(beat[:, -1], static[:, -1]),
        "last_to_exp3": ratio_estimate(beat[:, -1], exp3[:, -1]),
        "regret_to_exp3": regret_ratio(beat),
        "worst_ratio_10_to_60": naming(result, instead)["worst_ratio_10_to_60"],
    }
    if BEAT_OURS in losses:
        found["regret_to_exp3_without_exploration"] = regret_ratio(losses[BEAT_OURS])
    return found


readings = trials.readings_by(numbers)
