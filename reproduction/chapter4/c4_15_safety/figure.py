"""Loss by episode, and regret summed over episodes, of the best static speed, EXP-3 and BEAT."""

from collections.abc import Mapping

from lifelore.figures.style import LIGHT, Figure, house_style, new_figure
from reproduction.chapter4.ball_game.looks import WORDS, method_lines
from reproduction.figures.curves import draw_curves

TITLES = {"loss": "Safety: mean loss of an episode", "regret": "Efficiency: summed regret"}


@house_style()
def draw(result: Mapping) -> Figure:
    """Both panels over populations of all sizes; regret is the loss above that of each type's best speed."""
    figure = new_figure(8.4, 3.4)
    for axes, (what, title) in zip(figure.subplots(1, 2), TITLES.items(), strict=True):
        rows = [row for row in result["rows"] if row["what"] == what]
        series = {WORDS[row["method"]]: {key: row[key] for key in ("mean", "low", "high")} for row in rows}
        looks = method_lines(marker="o", markersize=4)
        draw_curves(axes, None, series, looks=looks, title=title, xlabel="episode", legend=what == "regret")
        axes.set(xticks=range(1, len(rows[0]["mean"]) + 1))
        axes.grid(axis="y", color=LIGHT)
    return figure
