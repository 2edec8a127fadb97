"""Loss by the diversity of the population, and the loss of BEAT as printed over the others' (Figure 4.16)."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import frame_cells
from lifelore.figures.style import GREY, Axes, Figure, house_style, new_figure
from reproduction.chapter4.ball_game.methods import BEAT, BEAT_PRINTED, PRINTED_EXP3, STATIC, TUNED_EXP3
from reproduction.chapter4.c4_12_user_diversity.measure import FEW, MANY
from reproduction.chapter4.reuse.looks import GAMES_IN_WORDS, draw_ratio_grid, legend_below, lines_of
from reproduction.engine.results_table import ResultsTable

WITH_BAND = (PRINTED_EXP3, STATIC, BEAT_PRINTED, BEAT)
SHOWN = (
    PRINTED_EXP3, TUNED_EXP3, STATIC, BEAT_PRINTED, "BEAT, ε = 1/n", BEAT, "BEAT, told the population",
    "best speed of each type",
)  # fmt: skip
COLUMNS = {
    "EXP-3 as\nprinted": (PRINTED_EXP3, (*FEW, *MANY)),
    "static,\n1–3 types": (STATIC, FEW),
    "static,\n4–6 types": (STATIC, MANY),
    "EXP-3\ntuned": (TUNED_EXP3, (*FEW, *MANY)),
}
"""By head of a column the other method, and the numbers of types in the populations."""


def draw(result: Mapping) -> Figure:
    table = ResultsTable(result["rows"], ("words", "diversity"))
    games = table.distinct("words")
    with house_style():
        figure = new_figure(10.4, max(4.4, 0.3 * len(games) + 2.2))
        left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
        _draw_losses(left, games[0], table.select(words=games[0]).records)
        values = np.array([_ratios(table.select(words=game)) for game in games])
        draw_ratio_grid(right, values, games, list(COLUMNS))
        frame_cells(right, (0, 0), (1, 3))
        right.set_title("loss of BEAT, ε as printed,\ndivided by the loss of the other method", loc="right")
        words = (
            f"{GAMES_IN_WORDS}\nStatic: the best static speed of the population. Framed: what the verdict reads."
        )
        figure.supxlabel(words, fontsize=8, color=GREY)
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
    """The loss of BEAT as printed over that of each column's method, all populations weighed alike."""
    ratios = []
    for other, diversities in COLUMNS.values():
        rows = [row for row in table.records if row["diversity"] in diversities]
        weights = [row["populations"] for row in rows]
        mine, others = (
            np.average([row["loss"][m] for row in rows], weights=weights) for m in (BEAT_PRINTED, other)
        )
        ratios.append(float(mine / others))
    return ratios
