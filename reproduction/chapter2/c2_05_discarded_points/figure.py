"""Pairs classified exactly while points are discarded, by how contacts are found (§2.4.1)."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, ORANGE, VERMILION, Axes
from reproduction.chapter2.c2_05_discarded_points.run import METHODS
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

LOOKS = dict(zip(METHODS, (BLUE, ORANGE, VERMILION), strict=True))


@panels(5.6, 3.4)
def draw(result: Mapping, axes: Axes) -> None:
    """A curve for each method with its 95 % band; a line at the thesis's 70 %."""
    curves = {}
    for method in METHODS:
        own = [row for row in result["rows"] if row["method"] == method]
        ends = [row["ci95"] or [row["value"]] * 2 for row in own]
        curves[method] = {
            "x": [100 * row["discarded"] for row in own],
            "mean": [100 * row["value"] for row in own],
            "low": [100 * low for low, _ in ends],
            "high": [100 * high for _, high in ends],
        }
    looks = {name: {"color": colour, "marker": "o", "markersize": 3.6} for name, colour in LOOKS.items()}
    draw_curves(
        axes, None, curves, looks=looks, xlabel="points discarded (%)", ylabel="pairs classified exactly (%)"
    )
    axes.axvline(70, color=GREY, lw=1, ls=(0, (4, 3)), zorder=1)
    axes.annotate("thesis: robust up to 70 %", (70, 0.02), (-4, 0), xycoords=("data", "axes fraction"),
                  textcoords="offset points", ha="right", fontsize=8, color=GREY)  # fmt: skip
    axes.set_ylim(0, 100)
