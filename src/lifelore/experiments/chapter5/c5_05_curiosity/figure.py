"""Points missed on new orders after spare time, by how its contexts are chosen."""

from collections.abc import Mapping

import numpy as np

from lifelore.experiments.chapter5.c5_05_curiosity.run import CURIOUS, LEARNABLE, UNIFORM
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREY, LIGHT, ORANGE, Figure, house_style, new_figure

LABELS = {
    UNIFORM: "uniform replay",
    CURIOUS: "entropy × frequency",
    LEARNABLE: "its removable part × frequency",
}
LOOKS = {UNIFORM: {"color": GREY}, CURIOUS: {"color": BLUE, "linewidth": 2.2}, LEARNABLE: {"color": ORANGE}}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings = result["settings"]
    figure = new_figure(6.4, 4.2)
    axes = figure.subplots()
    series = {
        LABELS[row["chooser"]]: {"mean": row["mean"], "error": 1.96 * np.array(row["error"])}
        for row in result["rows"]
    }
    spans = settings["every"] * np.arange(len(result["rows"][0]["mean"]))
    looks = {LABELS[chooser]: look for chooser, look in LOOKS.items()}
    draw_curves(
        axes, spans, series, looks=looks, title="Spare orders, by how their context is chosen",
        xlabel="spare orders", legend=False,
    )  # fmt: skip
    axes.set_ylabel("points below the best possible return")
    axes.grid(axis="y", color=LIGHT)
    axes.legend()
    return figure
