"""Loss of the best static speed, EXP-3 and BEAT by the diversity of the population (Figure 4.16)."""

from collections.abc import Mapping

from lifelore.figures.style import Axes
from reproduction.chapter4.ball_game.looks import WORDS, method_lines
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels


@panels(5.6, 3.6)
def draw(result: Mapping, axes: Axes) -> None:
    """The three curves of the thesis; intervals, paired by runs, stand with the statements."""
    series = {WORDS[row["method"]]: {"mean": row["mean"]} for row in result["rows"]}
    draw_curves(axes, None, series, looks=method_lines(marker="o", markersize=4))
    axes.set(xlabel="population diversity (types)", ylabel="mean loss of an episode", xticks=range(1, 7))
