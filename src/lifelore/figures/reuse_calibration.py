"""Picture of calibration: shares observed over predicted quantiles of outcomes."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lifelore.figures.style import BLUE, GREY, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw_calibration(found: Mapping[str, Any]) -> "Figure":
    """Shares of outcomes at or below predicted quantiles; points on the dashed line are right.

    Parameters
    ----------
    found : mapping
        Plain data with ``predicted``, ``observed``, ``ci95``, ``n``, ``groups`` and ``error``.
    """
    with house_style():
        figure = new_figure(4.2, 4.5)
        _draw(figure.subplots(), found)
        figure.supxlabel("dashed: calibrated; bars: 95 % intervals by the spread of users", fontsize=8, color=GREY)
    return figure


def _draw(axes: "Axes", found: Mapping[str, Any]) -> None:
    axes.plot([0, 1], [0, 1], color=GREY, linestyle=(0, (4, 3)), linewidth=1.1, zorder=1)
    axes.plot(found["predicted"], found["observed"], color=BLUE, linewidth=1.2, alpha=0.6, zorder=2)
    for place, share, interval in zip(found["predicted"], found["observed"], found["ci95"], strict=True):
        if interval:
            axes.plot([place, place], interval, color=BLUE, linewidth=1.4, zorder=3)
        axes.plot([place], [share], "o", color=BLUE, ms=7, zorder=4)
    axes.set(
        title="Quantiles of outcomes", xlabel="level of the predicted quantile",
        ylabel="share of outcomes at or below it", xlim=(-0.02, 1.02), ylim=(-0.02, 1.02),
    )  # fmt: skip
    axes.set_aspect("equal")
    axes.grid(color=LIGHT)
    of = f"{found['n'][0]:,} predictions for {found['groups']:,} users"
    words = f"{of}\nmean distance {found['error']:.3f}"
    axes.text(0.03, 0.97, words, transform=axes.transAxes, va="top", fontsize=8, color=GREY)
