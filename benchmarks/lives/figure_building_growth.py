"""Seconds of a task and memory of the process as buildings grow."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREEN, GREY, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw_building_growth(
    places: Sequence[float], first: Sequence[float], later: Sequence[float], megabytes: Sequence[float]
) -> "Figure":
    """The figure: seconds on the left, memory on the right, both over the number of places.

    Parameters
    ----------
    places : (n,) numbers of places, increasing
    first, later : (n,) seconds of the first task and of a later one
    megabytes : (n,) largest memory of the process
    """
    with house_style():
        figure = new_figure(9.4, 3.6)
        left, right = figure.subplots(1, 2)
        _line(left, places, first, BLUE, "first task (all of the building is stored)")
        _line(left, places, later, ORANGE, "later task")
        # In proportion to the places: what grows faster would leave this line upwards.
        left.plot(
            places, [first[0] * n / places[0] for n in places], color=GREY, linewidth=1, linestyle=(0, (2, 2)),
            label="in proportion to the places",
        )  # fmt: skip
        left.set(xscale="log", yscale="log", xlabel="places", ylabel="seconds a task, lore and scratch")
        left.legend(loc="upper left", frameon=False, fontsize=8)
        _line(right, places, megabytes, GREEN, "")
        right.set(
            xscale="log", xlabel="places", ylabel="memory of the process, MB", ylim=(0, max(megabytes) * 1.15)
        )
        figure.suptitle("What a task costs as buildings grow")
    return figure


def _line(axes: "Axes", x: Sequence[float], y: Sequence[float], colour: str, label: str) -> None:
    axes.plot(x, y, color=colour, marker="o", markersize=4, linewidth=1.8, label=label)
    for place, value in zip(x, y, strict=True):
        # Below to the right, where no line that rises passes.
        axes.annotate(f"{value:#.2g}" if value < 10 else f"{value:.0f}", (place, value), (3, -11),
                      textcoords="offset points", fontsize=7.5)  # fmt: skip
    axes.margins(0.1)
