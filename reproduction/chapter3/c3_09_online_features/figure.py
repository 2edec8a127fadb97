"""Figure of claim C3.9: reward in the first and the last episode of each task."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, PURPLE, Figure, house_style, new_figure
from reproduction.chapter3.c3_09_online_features.run import DRAWN, METHODS
from reproduction.chapter3.factory.figure import looks_of
from reproduction.figures.curves import draw_curves

LOOKS = looks_of(
    METHODS,
    {
        "uniform": ("uniform prior", GREY),
        "full": ("all ten features", PURPLE),
        "selected": ("selected features", BLUE),
    },
)
DASHES = {"first": "-", "last": (0, (4, 2))}


@house_style()
def draw(result: Mapping) -> Figure:
    """Two bundles of lines: first episodes, and the last ones above them."""
    settings, series, looks = result["settings"], {}, {}
    for row in result["rows"]:
        words, colour = LOOKS[row["curve_of"]]
        label = f"{words}, episode {1 if row['part'] == 'first' else settings['episodes']}"
        # Shades of both bundles would hide one another.
        series[label] = row if row["part"] == "first" else {"mean": row["mean"]}
        looks[label] = {"color": colour, "linewidth": 1.5, "linestyle": DASHES[row["part"]]}
    figure = new_figure(6.8, 4.4)
    axes = figure.subplots()
    draw_curves(
        axes, None, series, looks=looks, xlabel="task", ylabel="reward of an episode", legend=False,
    )  # fmt: skip
    lowest = min(np.min(row["mean"]) for row in result["rows"])
    axes.set(xlim=(1, settings["tasks"]), ylim=(1.1 * lowest, -0.06 * lowest))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=2)
    runs = min(DRAWN, settings["runs"])
    figure.supxlabel(f"{runs} runs; shaded: one standard deviation of the first episodes.", fontsize=8, color=GREY)
    return figure
