"""The world an agent lives in, and the ways it has learnt to take through it."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.figures.lives.floor_plan import FloorPlan
from lifelore.figures.lives.map_plan import MapPlan
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
    plan: FloorPlan | MapPlan, ways: Sequence[Mapping], *, goals: ArrayLike = (), title: str = ""
) -> "Figure":
    """The map or the cells with the ways of a few tasks.

    Parameters
    ----------
    plan : FloorPlan or MapPlan
    ways : sequence of mapping
        One a task: ``{"label", "goal": (x, y), "paths": [(n, 2) x and y, …]}``, in metres.
    goals : (n, 2) float
        Goals of other tasks, drawn small.
    title : str
    """
    with house_style():
        inches = _size(*plan.size)
        figure = new_figure(*inches)
        axes = figure.subplots()
        plan.draw(axes)
        for i, way in enumerate(ways):
            aside = plan.lane * (i - (len(ways) - 1) / 2)
            _draw_way(axes, plan, way, _TASK_COLOURS[i % len(_TASK_COLOURS)], aside)
        if np.size(goals):
            axes.plot(
                *plan.placed(goals).T, "D", markersize=4, color=INK, alpha=0.35, markeredgewidth=0, zorder=4,
                label="earlier goals",
            )  # fmt: skip
        axes.plot([], [], "o", color=GREY, markersize=6, markeredgecolor=PAPER, label="start of a way")
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


def _draw_way(axes: "Axes", plan: FloorPlan | MapPlan, way: Mapping, colour: str, aside: float) -> None:
    from matplotlib.patheffects import Normal, Stroke

    for path in way["paths"]:
        x, y = plan.placed(path).T + aside
        casing = [Stroke(linewidth=2.9, foreground=PAPER, alpha=0.9), Normal()]
        axes.plot(x, y, color=colour, linewidth=1.7, solid_joinstyle="round", path_effects=casing, zorder=5)
        axes.plot(x[0], y[0], "o", color=colour, markersize=5.5, markeredgecolor=PAPER, zorder=7)
    x, y = plan.placed(way["goal"])[0]
    axes.plot(
        x, y, "*", color=colour, markersize=17, markeredgecolor=PAPER, markeredgewidth=1.0, zorder=8,
        label=way["label"],
    )  # fmt: skip
