"""Mean return of an episode by world, with and without the prior, under two schedules of ε: a dot a life."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, LIGHT, Figure, house_style, new_figure
from reproduction.own.o_03_your_worlds.run import EPSILONS

COLOURS = {"all_lore": BLUE, "all_scratch": GREY}


@house_style()
def draw(result: Mapping) -> Figure:
    """A panel a world, as their returns have different scales; blue: with the prior, a line at each mean."""
    worlds = result["settings"]["worlds"]
    figure = new_figure(1.8 * len(worlds) + 0.6, 2.7)
    for axes, world in zip(np.ravel(figure.subplots(1, len(worlds))), worlds, strict=True):
        for column, epsilon in enumerate(EPSILONS):
            for shift, (name, colour) in zip((-0.2, 0.2), COLOURS.items(), strict=True):
                own = [r[name] for r in result["rows"] if (r["world"], r["epsilon"]) == (world, epsilon)]
                axes.plot([column + shift] * len(own), own, "o", color=colour, alpha=0.5, ms=5, mew=0)
                axes.plot([column + shift - 0.15, column + shift + 0.15], [np.mean(own)] * 2, color=colour, lw=2)
        axes.set_xticks(range(len(EPSILONS)), [f"ε = {name}" for name in EPSILONS], fontsize=7)
        axes.set_title(world, fontsize=8)
        axes.grid(axis="y", color=LIGHT)
    figure.axes[0].set_ylabel("mean discounted return")
    figure.suptitle("blue: with the prior of earlier tasks; grey: without", fontsize=9, x=0.01, ha="left")
    return figure
