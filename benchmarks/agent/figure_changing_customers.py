"""What agents miss of the best possible return in the episodes around a change of the customer."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREEN, GREY, LIGHT, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = {"following": BLUE, "static": VERMILION, "scratch": GREY, "told of changes": GREEN}


def draw_changing_customers(curves: Mapping[str, Mapping[int, tuple[float, float]]]) -> "Figure":
    """The figure.

    Parameters
    ----------
    curves : mapping
        By agent: number of episodes since the change (below 0: before it) to the mean of the points missed and
        half of its 95 % interval.
    """
    with house_style():
        figure = new_figure(6.4, 3.9)
        axes = figure.subplots()
        for name, points in curves.items():
            episodes = list(points)
            means, errors = zip(*points.values(), strict=True)
            axes.errorbar(
                episodes, means, errors, color=COLOURS[name], marker="o", markersize=4, linewidth=1.6, capsize=2.5,
                label=name,
            )  # fmt: skip
        axes.axvline(-0.5, color=GREY, linestyle=(0, (2, 2)), linewidth=1)
        axes.set(
            title="Another customer comes", xlabel="episodes since the change",
            ylabel="points below the best possible return",
        )  # fmt: skip
        axes.set_ylim(bottom=0)
        axes.grid(color=LIGHT)
        axes.legend(loc="upper left", frameon=False)
    return figure
