"""Figure of claim C3.9: reward in the first and the last episode of each task."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, PURPLE, Axes
from reproduction.chapter3.c3_09_online_features.run import DRAWN
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

LOOKS = {
    "uniform": ("uniform prior", GREY),
    "full": ("all ten features", PURPLE),
    "selected": ("selected features", BLUE),
}
DASHES = {"first": "-", "last": (0, (4, 2))}


@panels(6.8, 4.4, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """Two bundles of lines: first episodes, and the last ones above them."""
    settings, series, looks = result["settings"], {}, {}
    for row in result["rows"]:
        words, colour = LOOKS[row["curve_of"]]
        label = f"{words}, episode {1 if row['part'] == 'first' else settings['episodes']}"
        # Shades of both bundles would hide one another.
        series[label] = row if row["part"] == "first" else {"mean": row["mean"]}
        looks[label] = {"color": colour, "linewidth": 1.5, "linestyle": DASHES[row["part"]]}
    draw_curves(
        axes, None, series, looks=looks, xlabel="task", ylabel="reward of an episode", legend=False,
    )  # fmt: skip
    lowest = min(np.min(row["mean"]) for row in result["rows"])
    axes.set(xlim=(1, settings["tasks"]), ylim=(1.1 * lowest, -0.06 * lowest))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=2)
    runs = min(DRAWN, settings["runs"])
    axes.figure.supxlabel(
        f"{runs} runs; shaded: one standard deviation of the first episodes.", fontsize=8, color=GREY
    )
