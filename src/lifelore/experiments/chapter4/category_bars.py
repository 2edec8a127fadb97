"""How likely each coarse category of a shot is, by club and hole (the thesis's Figure 4.3)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.style import BLUE, GREEN, GREY, ORANGE, PURPLE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CLUB_COLOURS = (BLUE, GREEN, ORANGE, PURPLE)
_REACH = 80.0
"""How far the two outer categories are drawn, in yards; they have no end."""


def draw_category_bars(
    probs: ArrayLike, edges: Sequence[float], clubs: Sequence[str], holes: Sequence[float]
) -> "Figure":
    """A panel a club and hole, bars as wide as their category.

    Parameters
    ----------
    probs : (n_holes, n_clubs, n_categories) float
    edges : (n_categories - 1,) float
        Yards beyond the hole at which a category ends.
    clubs, holes : names and yards
    """
    with house_style():
        figure = new_figure(8.4, 5.6)
        panels = figure.subplots(len(holes), len(clubs), sharex=True, sharey=True, squeeze=False)
        fill_category_bars(panels, probs, edges, clubs, holes)
        figure.suptitle("How a shot is described: probability of each category of its error", x=0.01, ha="left")
    return figure


def fill_category_bars(
    panels: NDArray, probs: ArrayLike, edges: Sequence[float], clubs: Sequence[str], holes: Sequence[float]
) -> None:
    """Draw into `panels` (n_holes, n_clubs) of axes; see `draw_category_bars`."""
    table = np.asarray(probs, float)
    ends = np.array([-_REACH, *edges, _REACH])
    for i, hole in enumerate(holes):
        for j, club in enumerate(clubs):
            axes: Axes = panels[i][j]
            axes.bar(
                ends[:-1], table[i, j], np.diff(ends), align="edge", color=CLUB_COLOURS[j % len(CLUB_COLOURS)],
                edgecolor="white", lw=0.8,
            )  # fmt: skip
            axes.axvline(0, color=GREY, lw=0.7, ls=(0, (2, 2)))
            axes.set(xlim=(-_REACH, _REACH), ylim=(0, 1.05), yticks=[0, 0.5, 1], xticks=[-50, -20, 0, 20, 50])
            axes.tick_params(labelsize=7, length=2)
            if i == 0:
                axes.set_title(club, loc="center")
            if j == 0:
                axes.set_ylabel(f"{hole:g} yd")
            if i == len(holes) - 1:
                axes.set_xlabel("yards beyond the hole", fontsize=8)
