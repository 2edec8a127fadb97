"""Bars with intervals: a value for each name, in groups, with its 95 % interval."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from lifelore.figures.style import BLUE, INK, PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Number = Mapping[str, Any]
"""``{"value", "ci95"}``; `ci95` is (low, high) or None."""


def draw_interval_bars(
    axes: "Axes",
    names: Sequence[str],
    groups: Mapping[str, Sequence[Number | None]],
    *,
    colours: Mapping[str, str] | Sequence[str] = (),
    horizontal: bool = True,
    words: Callable[[float], str] | None = "{:.3g}".format,
    label: str = "",
    legend: bool | None = None,
) -> None:
    """Draw a bar for each name and group.

    Parameters
    ----------
    axes : matplotlib axes
    names : sequence of str
        Ticks, top to bottom where `horizontal`, else left to right.
    groups : mapping
        Label of the group → a number for each name; None leaves its place empty.
    colours : mapping or sequence of str
        Colour by group, or a list of colours, one for each name; with one group, a colour for each name.
    horizontal : bool
    words : callable, optional
        Text of a value, written at the end of its bar; None writes none.
    label : str
        Label of the axis of values.
    legend : bool, optional
        Default: where there are several groups.
    """
    height = 0.8 / len(groups)
    for g, (group, numbers) in enumerate(groups.items()):
        for place, number in enumerate(numbers):
            if number is None or number["value"] is None:
                continue
            value, interval = number["value"], number.get("ci95") or ()
            at = place + (g - (len(groups) - 1) / 2) * height
            colour = _colour(colours, group, g, place, len(groups))
            bar = axes.barh if horizontal else axes.bar
            bar([at], [value], height * 0.92, color=colour, label=None if _has(axes, group) else group)
            if interval:
                ends = (interval, [at, at]) if horizontal else ([at, at], interval)
                axes.plot(*ends, color=INK, linewidth=1.1, solid_capstyle="butt")
            if words:
                _write(axes, words(value), max([value, *interval]), at, horizontal)
    _ticks(axes, names, horizontal)
    axes.set(**{"xlabel" if horizontal else "ylabel": label})
    if len(groups) > 1 if legend is None else legend:
        axes.legend()


def _colour(colours, group: str, g: int, place: int, n_groups: int) -> str:
    if isinstance(colours, Mapping):
        return colours.get(group, BLUE)
    if not colours:
        return BLUE
    return colours[place if n_groups == 1 and len(colours) > 1 else g]


def _has(axes: "Axes", label: str) -> bool:
    return label in axes.get_legend_handles_labels()[1]


def _write(axes: "Axes", text: str, end: float, at: float, horizontal: bool) -> None:
    place, offset = ((end, at), (4, 0)) if horizontal else ((at, end), (0, 3))
    across, along = ("left", "center") if horizontal else ("center", "bottom")
    axes.annotate(
        text, place, offset, textcoords="offset points", fontsize=7.5, ha=across, va=along, zorder=7,
        bbox={"facecolor": PAPER, "alpha": 0.8, "edgecolor": "none", "pad": 0.4}, linespacing=0.95,
    )  # fmt: skip


def _ticks(axes: "Axes", names: Sequence[str], horizontal: bool) -> None:
    if horizontal:
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.4, -0.6)
        axes.spines["left"].set_visible(False)
        axes.tick_params(axis="y", length=0)
    else:
        axes.set_xticks(range(len(names)), names)
        axes.tick_params(axis="x", length=0)
