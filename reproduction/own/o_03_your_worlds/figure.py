"""Gains over the textbook learner by world, over whole tasks and their last tenth, with 95 % intervals."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.figures.style import BLUE, GREY, INK, Figure, new_figure
from reproduction.own.o_03_your_worlds.run import numbers

SHOWN = {"all_over_textbook": ("over all episodes", BLUE), "last_over_textbook": ("in the last tenth", GREY)}


def draw(result: Mapping) -> Figure:
    """A row a world; gains in units of the deviation of the gain of a life, as returns have different scales."""
    worlds = result["settings"]["worlds"]
    figure = new_figure(6.4, 0.34 * len(worlds) + 1.1)
    axes = figure.subplots()
    for place, world in enumerate(worlds):
        found = numbers(result["rows"], world)
        for shift, (name, (_, colour)) in zip((-0.14, 0.14), SHOWN.items(), strict=True):
            value, low, high = _scaled(result, world, name, found[name])
            axes.plot([low, high], [place + shift] * 2, color=colour, lw=2)
            axes.plot([value], [place + shift], "o", color=colour, ms=4)
    for text, colour in SHOWN.values():
        axes.plot([], [], "o-", color=colour, label=text)
    axes.axvline(0, color=INK, lw=0.8)
    axes.set_yticks(range(len(worlds)), worlds)
    axes.invert_yaxis()
    axes.set_xlabel("gain over the textbook learner (deviations between lives)")
    axes.legend(loc="lower right", fontsize=8)
    return figure


def _scaled(result: Mapping, world: str, name: str, gain: Estimate) -> tuple[float, float, float]:
    key = name.removesuffix("_over_textbook")
    own = [row for row in result["rows"] if row["world"] == world]
    deviation = float(np.std([row[f"{key}_lore"] - row[f"{key}_textbook"] for row in own])) or 1.0
    low, high = gain.ci95 or (gain.value, gain.value)
    return gain.value / deviation, low / deviation, high / deviation
