"""First episodes by family, and what each part of the agent pays, with 95 % intervals."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREEN, INK, LIGHT, ORANGE, PURPLE, Figure, house_style, new_figure
from reproduction.chapter5.c5_10_one_life.lives import PARTS

COLOURS = {"prior": ORANGE, "reuse": GREEN, "context": PURPLE}


@house_style()
def draw(result: Mapping) -> Figure:
    """Above: the share of the way to an agent that knows the type. Below: what each part pays in mean return."""
    figure = new_figure(9.0, 5.0)
    above, below = figure.subplots(2, 1, sharex=True)
    names = [one["cell"]["family"] for one in result["readings"]]
    places = np.arange(len(names))
    _bars(above, places, [one["first_share"] for one in result["readings"]], 0.5, BLUE, "")
    above.axhline(0.9, color=INK, linestyle=":", linewidth=1)
    above.set_ylabel("first episode: share of\nwho knows the type")
    for number, (part, colour) in enumerate(COLOURS.items()):
        measured = [one[f"{part}_gain"] for one in result["readings"]]
        _bars(below, places + 0.27 * (number - (len(PARTS) - 1) / 2), measured, 0.24, colour, part)
    below.axhline(0, color=INK, linewidth=1)
    below.set_ylabel("mean return that a part adds\nin units of the spread")
    below.set_xticks(places, names)
    below.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(PARTS))
    for axes in (above, below):
        axes.grid(axis="y", color=LIGHT)
        axes.set_axisbelow(True)
    return figure


def _bars(axes, places, measured, width: float, colour: str, label: str) -> None:
    axes.bar(places, [one["value"] for one in measured], width, color=colour, label=label)
    for place, one in zip(places, measured, strict=True):
        if one["ci95"]:
            axes.plot([place, place], one["ci95"], color=INK, linewidth=1)
