"""How well several methods do, each with its interval, on several sets of scenes side by side."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lifelore.core.errors import InputError
from lifelore.figures.object_palette import method_palette
from lifelore.figures.style import INK, LIGHT, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase


def draw_method_bars(
    panels: Mapping[str, Mapping[str, Mapping]],
    *,
    goals: Mapping[str, float] | None = None,
    xlabel: str = "pairs told exactly (%)",
) -> "Figure":
    """Bars, one panel a set of scenes.

    Parameters
    ----------
    panels : mapping of title to mapping of method to measurement
        A measurement is ``{"value", "ci95", "n"}``, a share in [0, 1] and the ends of its interval, as in a
        claim's result; methods in the order of the first panel, top to bottom.
    goals : mapping of title to float, optional
        A share to reach, drawn as a dashed line.
    xlabel : str

    Raises
    ------
    InputError
        There is no panel.
    """
    if not panels:
        raise InputError("panels must name at least one set of scenes, got none")
    names = list(dict.fromkeys(name for panel in panels.values() for name in panel))
    with house_style():
        figure = new_figure(1.6 + 2.9 * len(panels), 0.95 + 0.3 * len(names))
        draw_bars(figure, panels, goals=goals, xlabel=xlabel)
    return figure


def draw_bars(
    figure: "FigureBase",
    panels: Mapping[str, Mapping[str, Mapping]],
    *,
    goals: Mapping[str, float] | None = None,
    xlabel: str = "pairs told exactly (%)",
) -> None:
    """As `draw_method_bars`, into a figure or a part of one, within the house style."""
    names = list(dict.fromkeys(name for panel in panels.values() for name in panel))
    palette = method_palette(names)
    every = figure.subplots(1, len(panels), squeeze=False, sharey=True)[0]
    for axes, (title, panel) in zip(every, panels.items(), strict=True):
        for place, name in enumerate(names):
            if name in panel:
                _bar(axes, place, panel[name], palette[name])
        sizes = {measured["n"] for measured in panel.values()}
        axes.set_title(f"{title} ({sizes.pop():,} pairs)" if len(sizes) == 1 else title)
        axes.set(xlim=(0, 112), xticks=range(0, 101, 20), xlabel=xlabel)
        axes.grid(axis="x", color=LIGHT)
        if title in (goals or {}):
            axes.axvline(100 * (goals or {})[title], color=INK, lw=1.1, ls=(0, (4, 3)), zorder=3)
    every[0].set_yticks(range(len(names)), names)
    every[0].set_ylim(len(names) - 0.4, -0.6)
    for axes in every:
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)


def _bar(axes: "Axes", place: int, measured: Mapping, colour: str) -> None:
    value = 100 * measured["value"]
    axes.barh([place], [value], height=0.7, color=colour, alpha=0.9, zorder=2)
    end = value
    if measured.get("ci95"):
        low, high = (100 * bound for bound in measured["ci95"])
        axes.plot([low, high], [place, place], color=INK, lw=1.2, solid_capstyle="butt", zorder=4)
        end = max(end, high)
    axes.annotate(
        f"{value:.1f}", (end, place), (4, 0), textcoords="offset points", va="center", fontsize=7.5,
        color=INK, zorder=5,
        bbox={"facecolor": PAPER, "alpha": 0.85, "edgecolor": "none", "pad": 0.6},
    )  # fmt: skip
