"""Loss by the diversity of the population, and BEAT's loss as a ratio to the others' (Figure 4.16)."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.experiments.chapter4.ball_game.methods import BEAT, PRINTED_EXP3, STATIC, TUNED_EXP3
from lifelore.experiments.chapter4.reuse.looks import draw_ratio_grid, legend_below, lines_of
from lifelore.experiments.engine.results_table import ResultsTable
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import Axes, Figure, house_style, new_figure

WITH_BAND = (PRINTED_EXP3, STATIC, "BEAT, ε as printed", BEAT)
SHOWN = (
    PRINTED_EXP3, TUNED_EXP3, STATIC, "BEAT, ε as printed", "BEAT, ε = 1/n", BEAT, "BEAT, told the population",
    "best speed of each type",
)  # fmt: skip
COLUMNS = ["EXP-3\nprinted", "EXP-3\ntuned", *(f"static\nof {x}" for x in (1, 3, 6))]


def draw(result: Mapping) -> Figure:
    table = ResultsTable(result["rows"], ("words", "diversity"))
    games = table.distinct("words")
    with house_style():
        figure = new_figure(10.4, max(3.8, 0.3 * len(games) + 1.6))
        left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
        _draw_losses(left, games[0], table.select(words=games[0]).records)
        values = np.array([_ratios(table.select(words=game)) for game in games])
        draw_ratio_grid(right, values, games, COLUMNS)
        right.set_title("loss of BEAT (ε = 0) as a share of that of")
    return figure


def _draw_losses(axes: Axes, game: str, rows: Sequence[Mapping]) -> None:
    series = {method: {"mean": [row["loss"][method] for row in rows]} for method in SHOWN}
    for method in WITH_BAND:
        series[method]["error"] = [row["error"][method] for row in rows]
    diversity = [row["diversity"] for row in rows]
    looks = lines_of(SHOWN, marker="o", markersize=3)
    draw_curves(axes, diversity, series, looks=looks, title=game, legend=False)
    axes.set(xlabel="types in the population", ylabel="mean loss of an episode, band 95 %", xticks=diversity)
    legend_below(axes, 0.45, ncols=2)


def _ratios(table: ResultsTable) -> list[float]:
    """BEAT's loss to EXP-3's, as printed and tuned, and to the static speed's at three diversities."""
    weights = [row["n"] for row in table.records]
    means = {m: np.average([row["loss"][m] for row in table.records], weights=weights) for m in SHOWN}
    static = [table.record(diversity=x)["loss"] for x in (1, 3, 6)]
    exp3 = [float(means[BEAT] / means[other]) for other in (PRINTED_EXP3, TUNED_EXP3)]
    return exp3 + [loss[BEAT] / loss[STATIC] for loss in static]
