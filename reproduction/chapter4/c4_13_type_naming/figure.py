"""The most likely size over the true size, step by step of the first episode (Figure 4.17)."""

from collections.abc import Mapping

from lifelore.figures.style import GREY, Axes
from reproduction.chapter4.ball_game.looks import size_lines
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels


@panels(6.4, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """A curve for each true size."""
    *sizes, last = result["rows"]
    series = {f"b = {row['size']}": {"mean": row["ratio"]} for row in sizes}
    draw_curves(axes, None, series, looks=size_lines([row["size"] for row in sizes], linewidth=1.6))
    axes.axhline(1, color=GREY, linestyle=(0, (4, 2)), linewidth=1)
    axes.axvline(last["half_of_first"], color=GREY, linewidth=1)
    axes.annotate(
        "half of the median\nfirst episode", (last["half_of_first"], 1), (4, -2), va="top", fontsize=8,
        xycoords=("data", "axes fraction"), textcoords="offset points", color=GREY,
    )  # fmt: skip
    axes.set(xlabel="step of the first episode", ylabel="most likely size / true size", ylim=(0, None))
    axes.legend(title="true size", ncols=2)
