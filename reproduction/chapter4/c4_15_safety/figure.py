"""Loss by episode, and regret summed over episodes, of the best static speed, EXP-3 and BEAT."""

from collections.abc import Mapping

from lifelore.figures.style import Axes
from reproduction.chapter4.ball_game.looks import WORDS, method_lines
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

TITLES = {"loss": "Safety: mean loss of an episode", "regret": "Efficiency: summed regret"}


@panels(8.4, 3.4, 1, 2)
def draw(result: Mapping, *every: Axes) -> None:
    """Both panels over populations of all sizes; regret is the loss above that of each type's best speed."""
    for axes, (what, title) in zip(every, TITLES.items(), strict=True):
        rows = [row for row in result["rows"] if row["what"] == what]
        series = {WORDS[row["method"]]: {key: row[key] for key in ("mean", "low", "high")} for row in rows}
        looks = method_lines(marker="o", markersize=4)
        draw_curves(axes, None, series, looks=looks, title=title, xlabel="episode", legend=what == "regret")
        axes.set(xticks=range(1, len(rows[0]["mean"]) + 1))
