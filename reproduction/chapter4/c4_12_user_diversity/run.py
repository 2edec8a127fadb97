"""C4.12: BEAT, EXP-3 and constant speeds, by the diversity of the population. Thesis: §4.8.5.2, Figure 4.16."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.figures.style import Axes
from reproduction.chapter4.ball_game import trials
from reproduction.chapter4.ball_game.games import check_games
from reproduction.chapter4.ball_game.looks import WORDS, method_lines
from reproduction.chapter4.ball_game.trials import BEAT, EXP3, STATIC
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

cells, check, run_cell, shared = trials.cells, check_games, trials.run_cell, trials.SHARED
FEW, THREE, MANY, ALL = slice(0, 3), slice(2, 3), slice(3, 6), slice(0, 6)
"""Populations of 1 to 3 types, of 3, of 4 to 6, and all; every size weighs as much."""


def numbers(result: Mapping, instead: Mapping[str, str]) -> dict[str, Estimate]:
    """Ratios of losses of BEAT to EXP-3 and to the static speed, paired by runs; methods may be replaced."""
    losses = {method: np.array(result["losses"][instead.get(method, method)]) for method in (BEAT, EXP3, STATIC)}

    def ratio(other: str, sizes: slice) -> Estimate:
        mine, theirs = (losses[method][sizes].mean(axis=(0, 2)) for method in (BEAT, other))
        return ratio_estimate(mine, theirs)

    return {
        "to_exp3": ratio(EXP3, ALL),
        "to_static_few": ratio(STATIC, FEW),
        "to_static_at_3": ratio(STATIC, THREE),
        "to_static_many": ratio(STATIC, MANY),
    }


readings = trials.readings_by(numbers)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean loss of an episode by method and size of the population in the first game."""
    losses = {method: np.array(results[0]["losses"][method]).mean(axis=(1, 2)) for method in (STATIC, EXP3, BEAT)}
    return [{"method": method, "mean": lost.round(4).tolist()} for method, lost in losses.items()]


@panels(5.6, 3.6)
def draw(result: Mapping, axes: Axes) -> None:
    """Loss of the best static speed, EXP-3 and BEAT by the diversity of the population (Figure 4.16).

    The three curves of the thesis; intervals, paired by runs, stand with the statements.
    """
    series = {WORDS[row["method"]]: {"mean": row["mean"]} for row in result["rows"]}
    draw_curves(axes, None, series, looks=method_lines(marker="o", markersize=4))
    axes.set(xlabel="population diversity (types)", ylabel="mean loss of an episode", xticks=range(1, 7))
