"""Loss of the best static speed, EXP-3 and BEAT by the diversity of the population (Figure 4.16)."""

from collections.abc import Mapping

from lifelore.figures.style import LIGHT, Figure, house_style, new_figure
from reproduction.chapter4.ball_game.looks import WORDS, method_lines
from reproduction.figures.curves import draw_curves


@house_style()
def draw(result: Mapping) -> Figure:
    """The three curves of the thesis; intervals, paired by runs, stand with the statements."""
    figure = new_figure(5.6, 3.6)
    axes = figure.subplots()
    series = {WORDS[row["method"]]: {"mean": row["mean"]} for row in result["rows"]}
    draw_curves(axes, None, series, looks=method_lines(marker="o", markersize=4))
    axes.set(xlabel="population diversity (types)", ylabel="mean loss of an episode", xticks=range(1, 7))
    axes.grid(axis="y", color=LIGHT)
    return figure
