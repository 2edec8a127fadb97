"""Loss by the diversity of the population, and BEAT's loss as a ratio to the others' (Figure 4.16)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter4.reuse_figures import lines_of
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WITH_BAND = ("EXP-3 as printed", "best static speed", "BEAT, ε as printed", "BEAT")
SHOWN = (
    "EXP-3 as printed", "EXP-3 tuned", "best static speed", "BEAT, ε as printed", "BEAT, ε = 1/n", "BEAT",
    "BEAT, told the population", "best speed of each type",
)  # fmt: skip
COLUMNS = ["EXP-3\nprinted", "EXP-3\ntuned", *(f"static\nof {x}" for x in (1, 3, 6))]


def draw(result: Mapping) -> "Figure":
    """Curves of the first game, and ratios of all games."""
    rows = result["rows"]
    games = list(dict.fromkeys(row["words"] for row in rows))
    with house_style():
        figure = new_figure(10.4, max(3.8, 0.3 * len(games) + 1.6))
        left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
        _draw_losses(left, [row for row in rows if row["words"] == games[0]])
        values = np.array([_ratios([row for row in rows if row["words"] == game]) for game in games])
        draw_heat_grid(
            right, values, np.zeros(values.shape, bool), games, COLUMNS, neutral=1.0, spread=1.35, good="low",
            ratio=True, words="{:.2f}".format,
        )  # fmt: skip
        right.set_title("loss of BEAT (ε = 0) as a share of that of")
    return figure


def _draw_losses(axes: "Axes", rows: Sequence[Mapping]) -> None:
    series = {method: {"mean": [row["loss"][method] for row in rows]} for method in SHOWN}
    for method in WITH_BAND:
        series[method]["error"] = [row["error"][method] for row in rows]
    diversity = [row["diversity"] for row in rows]
    looks = lines_of(SHOWN, marker="o", markersize=3)
    draw_curves(axes, diversity, series, looks=looks, title=rows[0]["words"], legend=False)
    axes.set(xlabel="types in the population", ylabel="mean loss of an episode, band 95 %")
    low, high = axes.get_ylim()
    axes.set(xticks=diversity, ylim=(low - 0.45 * (high - low), high))  # room for the legend below the curves
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower left", ncols=2)


def _ratios(rows: Sequence[Mapping]) -> list[float]:
    """BEAT's loss to EXP-3's, as printed and tuned, and to the static speed's at three diversities."""

    def mean(method: str) -> float:
        return float(np.average([row["loss"][method] for row in rows], weights=[row["n"] for row in rows]))

    at = {row["diversity"]: row["loss"] for row in rows}
    exp3 = [mean("BEAT") / mean(other) for other in ("EXP-3 as printed", "EXP-3 tuned")]
    return exp3 + [at[x]["BEAT"] / at[x]["best static speed"] for x in (1, 3, 6)]
