"""Figure of `bench capacity`: memory and rates by number, measured and extrapolated, and bounds for a GPU."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT,
    ORANGE,
    PAPER,
    PURPLE,
    VERMILION,
    house_style,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Curves = Mapping[str, Mapping[int, float]]
_SIZES, _RATES = (BLUE, ORANGE, GREEN), (BLUE, ORANGE, VERMILION)


def draw_capacity_curves(
    sizes: Curves,
    planned: Curves,
    machine: float,
    rates: Curves,
    numbers: Sequence[float],
    bounds: Mapping[str, Sequence[float]],
    marks: Mapping[str, float],
    note: str,
) -> "Figure":
    """The figure.

    Parameters
    ----------
    sizes, rates : mapping of name to mapping of number to value
        Bytes, and pieces a second on one core, as measured; at most three names each, in the same order.
    planned : mapping of name to mapping of number to bytes
        Extrapolated, of some of the names of `sizes`.
    machine : float
        Bytes of memory of the machine.
    numbers, bounds : (n,) floats, and mapping of name to (n,) floats
        Q-learners, and the most steps a second of so many on a GPU; at most two names.
    marks : mapping of name to float
        Steps a second that are compared with; at most two names.
    note : str
        What the bounds assume.
    """
    with house_style():
        figure = new_figure(11.4, 4.1)
        memory, speed, gpu = figure.subplots(1, 3)
        _draw_sizes(memory, sizes, planned, machine)
        _draw_rates(speed, rates)
        _draw_bounds(gpu, numbers, bounds, marks)
        for axes in (memory, speed, gpu):
            axes.set_xscale("log")
            axes.minorticks_off()
            axes.grid(color=LIGHT)
        figure.supxlabel(note, fontsize=8, color=GREY)
    return figure


def _draw_sizes(axes: "Axes", sizes: Curves, planned: Curves, machine: float) -> None:
    for colour, (name, curve) in zip(_SIZES, sizes.items(), strict=False):
        axes.plot(list(curve), list(curve.values()), color=colour, marker="o", markersize=4, label=name)
        for number, value in planned.get(name, {}).items():
            ends = [max(curve), number], [curve[max(curve)], value]
            axes.plot(*ends, color=colour, linestyle=(0, (3, 2)), linewidth=1.2)
            axes.plot(number, value, "o", color=PAPER, markeredgecolor=colour, markersize=6, zorder=4)
    axes.axhline(machine, color=GREY, linewidth=1, zorder=1)
    axes.annotate(
        f"this machine has {machine / 1e9:.0f} GB", (0.02, machine), (0, 3), xycoords=("axes fraction", "data"),
        textcoords="offset points", fontsize=7.5, color=GREY,
    )  # fmt: skip
    axes.set(title="Memory (hollow: extrapolated)", xlabel="number", ylabel="bytes", yscale="log")
    axes.legend(loc="lower right")


def _draw_rates(axes: "Axes", rates: Curves) -> None:
    for colour, (name, curve) in zip(_RATES, rates.items(), strict=False):
        millions = [rate / 1e6 for rate in curve.values()]
        axes.plot(list(curve), millions, color=colour, marker="o", markersize=4, label=name)
    highest = max(rate / 1e6 for curve in rates.values() for rate in curve.values())
    axes.set(
        title="Rate on one core, measured", xlabel="number", ylabel="million a second", ylim=(0, 1.35 * highest)
    )
    axes.legend(loc="upper left", ncols=1)


def _draw_bounds(
    axes: "Axes", numbers: Sequence[float], bounds: Mapping[str, Sequence[float]], marks: Mapping[str, float]
) -> None:
    for style, (name, values) in zip(("solid", (0, (1.2, 1.4))), bounds.items(), strict=False):
        axes.plot(numbers, values, color=PURPLE, linestyle=style, label=f"a GPU at most, {name}")
    for colour, (name, value) in zip((GREY, INK), marks.items(), strict=False):
        axes.axhline(value, color=colour, linewidth=1.4, label=name)
    axes.set(title="Where a GPU could pay: arithmetic", xlabel="Q-learners", ylabel="steps a second", yscale="log")
    axes.set_ylim(top=100 * max(max(values) for values in bounds.values()))
    axes.legend(loc="upper left", fontsize=7.5)
