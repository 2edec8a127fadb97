"""The surveillance reserve: base, targets and hilltops (the thesis's Figure 4.9)."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from lifelore.figures.style import BLUE, GREEN, LIGHT, VERMILION, house_style, new_figure


def draw_reserve_maps(layouts: Mapping[str, tuple[ArrayLike, ArrayLike]], base: tuple[int, int], side: int):
    """A panel for each layout: its targets, (n, 2) rows and columns, and which of them are hilltops, (n,) bool.

    `base` is a row and a column, `side` the number of cells a side.
    """
    with house_style():
        figure = new_figure(2.55 * len(layouts), 3.1)
        panels = figure.subplots(1, len(layouts), squeeze=False)[0]
        for axes, (name, (targets, hilltops)) in zip(panels, layouts.items(), strict=True):
            _draw_reserve(axes, np.asarray(targets), np.asarray(hilltops, bool), base, side)
            axes.set_title(name)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _draw_reserve(axes, cells: np.ndarray, tops: np.ndarray, base: tuple[int, int], side: int) -> None:
    from matplotlib.patches import Rectangle

    lines = np.arange(side + 1) - 0.5
    axes.vlines(lines, -0.5, side - 0.5, color=LIGHT, lw=0.4, zorder=0)
    axes.hlines(lines, -0.5, side - 0.5, color=LIGHT, lw=0.4, zorder=0)
    groups = {
        "surveillance location": (cells[~tops], GREEN),
        "hilltop": (cells[tops], BLUE),
        "base station": ([base], VERMILION),
    }
    for label, (places, colour) in groups.items():
        for k, (row, column) in enumerate(places):
            square = Rectangle((column - 0.5, row - 0.5), 1, 1, fc=colour, ec="none", label="" if k else label)
            axes.add_patch(square)
    axes.set(xlim=(-0.5, side - 0.5), ylim=(side - 0.5, -0.5), aspect="equal", xticks=[], yticks=[])
