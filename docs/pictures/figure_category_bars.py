"""Bars of the probability of each category of a shot, by club and hole (Figure 4.3)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lifelore.figures.style import GREY, Figure, house_style, new_figure
from reproduction.chapter4.c4_02_golf_holes.run import CLUB_COLOURS

_REACH = 80.0
"""Yards to which the two outer categories are drawn; they have no end."""


def draw_category_bars(
    probs: ArrayLike, edges: Sequence[float], clubs: Sequence[str], holes: Sequence[float]
) -> Figure:
    """A panel a club and hole, bars as wide as their category.

    Parameters
    ----------
    probs : (n_holes, n_clubs, n_categories) float
    edges : (n_categories - 1,) float
        Yards beyond the hole at which a category ends.
    clubs, holes : names and yards
    """
    table = np.asarray(probs, float)
    ends = np.array([-_REACH, *edges, _REACH])
    with house_style():
        figure = new_figure(8.4, 5.6)
        panels = figure.subplots(len(holes), len(clubs), sharex=True, sharey=True, squeeze=False)
        for (i, j), axes in np.ndenumerate(panels):
            colour = CLUB_COLOURS[j % len(CLUB_COLOURS)]
            axes.bar(ends[:-1], table[i, j], np.diff(ends), align="edge", color=colour, edgecolor="white", lw=0.8)
            axes.axvline(0, color=GREY, lw=0.7, ls=(0, (2, 2)))
            axes.set(xlim=(-_REACH, _REACH), ylim=(0, 1.05), yticks=[0, 0.5, 1], xticks=[-50, -20, 0, 20, 50])
            axes.tick_params(labelsize=7, length=2)
        for axes, club in zip(panels[0], clubs, strict=True):
            axes.set_title(club, loc="center")
        for axes, hole in zip(panels[:, 0], holes, strict=True):
            axes.set_ylabel(f"{hole:g} yd")
        for axes in panels[-1]:
            axes.set_xlabel("yards beyond the hole", fontsize=8)
        figure.suptitle("How a shot is described: probability of each category of its error", x=0.01, ha="left")
    return figure
