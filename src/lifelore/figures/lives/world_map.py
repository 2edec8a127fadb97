"""The world an agent lives in, and the ways it has learnt to take through it."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.lives.floor_plan import draw_floor_plan, draw_scale_bar
from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PAPER,
    PURPLE,
    SKY,
    VERMILION,
    house_style,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LETTERS = 9.5
"""Letters of a title that fit in an inch."""
_LABEL = 3.0
"""Inches of a label of the legend, with its mark; narrow pictures get fewer columns."""
_TASK_COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)


def draw_world_map(
    shape: tuple[int, int],
    cells: ArrayLike,
    neighbour: ArrayLike,
    ways: Sequence[Mapping],
    *,
    goals: ArrayLike = (),
    cell: float | None = None,
    title: str = "",
) -> "Figure":
    """The floor plan with the ways of a few tasks.

    Parameters
    ----------
    shape, cells, neighbour
        See `draw_floor_plan`.
    ways : sequence of mapping
        One a task: ``{"label", "goal": (row, column), "paths": [(n, 2) rows and columns, …]}``.
    goals : (n, 2) int
        Row and column of goals of other tasks, drawn small.
    cell : float, optional
        Side of a cell in metres; with it a scale bar is drawn.
    title : str
    """
    cells = np.asarray(cells)
    height, width = np.ptp(cells, axis=0) + 3
    with house_style():
        inches = _size(height, width)
        figure = new_figure(*inches)
        axes = figure.subplots()
        draw_floor_plan(axes, shape, cells, neighbour, wall_width=_wall_width(width))
        for i, way in enumerate(ways):
            lane = _lane(width) * (i - (len(ways) - 1) / 2)
            _draw_way(axes, way, _TASK_COLOURS[i % len(_TASK_COLOURS)], lane)
        if np.size(goals):
            rows, columns = np.asarray(goals).T
            axes.plot(
                columns, rows, "D", markersize=4, color=INK, alpha=0.35, markeredgewidth=0, zorder=4,
                label="earlier goals",
            )  # fmt: skip
        axes.plot([], [], "o", color=GREY, markersize=6, markeredgecolor=PAPER, label="start of a way")
        if cell:
            draw_scale_bar(axes, cell)
        # The plan may be much narrower than the figure, and a title of the axes would begin at the plan.
        figure.suptitle(textwrap.fill(title, int(_LETTERS * inches[0])), x=0.01, horizontalalignment="left")
        axes.set_anchor("N")
        columns = int(np.clip(inches[0] / _LABEL, 1, 3))
        figure.legend(loc="outside lower center", ncols=columns, markerscale=0.7)
    return figure


def _size(height: float, width: float, area: float = 56.0) -> tuple[float, float]:
    """Inches of a figure of this shape, with room for title and legend."""
    unit = float(np.sqrt(area / (height * width)))
    return max(width * unit, 4.5), height * unit + 0.9


def _lane(columns: float) -> float:
    """Distance between the ways of two tasks through one cell, in cells: beside each other in a large plan too."""
    return float(np.clip(columns / 400.0, 0.15, 0.22))


def _wall_width(columns: float) -> float:
    return float(np.clip(90.0 / columns, 0.7, 1.8))


def _draw_way(axes: "Axes", way: Mapping, colour: str, lane: float) -> None:
    from matplotlib.patheffects import Normal, Stroke

    for path in way["paths"]:
        x, y = _in_lane(np.asarray(path), lane)
        casing = [Stroke(linewidth=2.9, foreground=PAPER, alpha=0.9), Normal()]
        axes.plot(x, y, color=colour, linewidth=1.7, solid_joinstyle="round", path_effects=casing, zorder=5)
        axes.plot(x[0], y[0], "o", color=colour, markersize=5.5, markeredgecolor=PAPER, zorder=7)
    row, column = way["goal"]
    axes.plot(
        column, row, "*", color=colour, markersize=17, markeredgecolor=PAPER, markeredgewidth=1.0, zorder=8,
        label=way["label"],
    )  # fmt: skip


def _in_lane(path: NDArray, lane: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """x and y of a path, a little beside the middle of its cells."""
    return path[:, 1] + lane, path[:, 0] + lane
