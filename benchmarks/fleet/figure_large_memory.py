"""Figure of `bench large_memory`: bytes, seconds and bytes read to open, over the number of contexts."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREEN, LIGHT, ORANGE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Curves = Mapping[str, Mapping[int, float]]
_COLOURS = (BLUE, ORANGE, GREEN, VERMILION)


def draw_large_memory(sizes: Curves, seconds: Curves) -> "Figure":
    """The figure: bytes on the left, seconds on the right, both over the number of contexts.

    Parameters
    ----------
    sizes, seconds : mapping of label to mapping of number of contexts to bytes or seconds
        At most four labels each.
    """
    with house_style():
        figure = new_figure(9.8, 3.9)
        left, right = figure.subplots(1, 2)
        _lines(left, sizes)
        left.set(title="Bytes", ylabel="bytes")
        _lines(right, seconds)
        right.set(title="Time of one core", ylabel="seconds")
    return figure


def _lines(axes: "Axes", curves: Curves) -> None:
    for colour, (label, curve) in zip(_COLOURS, curves.items(), strict=False):
        axes.plot(list(curve), list(curve.values()), color=colour, marker="o", markersize=4, label=label)
    highest = max(max(curve.values()) for curve in curves.values())
    axes.set(xscale="log", yscale="log", xlabel="contexts in memory")
    axes.set_ylim(top=100 * highest)
    axes.minorticks_off()
    axes.grid(color=LIGHT)
    axes.legend(loc="upper left", fontsize=7.5)
