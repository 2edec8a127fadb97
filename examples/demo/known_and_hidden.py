"""Both kinds of jobs in one picture: what searches for hidden goals cost, and what drives to known goals lost."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.figures.lives.drives import LearntFloor, draw_learnt_floor, draw_lost_time, draw_task_axis
from lifelore.figures.style import PAPER, colour_of, house_style, new_figure, width_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

RECENT = 7
"""Number of tasks over which a line of searches is a mean."""
_WORDS = {"lore": "with memory", "scratch": "without memory"}


def draw_known_and_hidden(
    searched: Mapping[str, ArrayLike],
    driven: Mapping[str, Mapping[str, ArrayLike]],
    floor: LearntFloor,
    *,
    title: str = "",
) -> "Figure":
    """Searches beside drives, and the floor as the drives taught it.

    Parameters
    ----------
    searched : mapping
        Agent's name to the metres of each search, (n,).
    driven : mapping
        As `draw_lost_time` takes it.
    floor : LearntFloor
    title : str
    """
    with house_style():
        figure = new_figure(14.5, 4.7)
        left, middle, right = figure.subplots(1, 3, width_ratios=(0.9, 0.95, 1.25))
        draw_searches(left, searched)
        jobs = len(np.asarray(next(iter(driven.values()))["lost"]))
        draw_lost_time(middle, 1 + np.arange(jobs), driven)
        draw_learnt_floor(right, floor)
        figure.suptitle(title, x=0.01, ha="left")
    return figure


def draw_searches(axes: "Axes", searched: Mapping[str, ArrayLike]) -> None:
    """Metres of each search, on a logarithmic scale: a point a task, and a line for their geometric mean."""
    from matplotlib.ticker import FuncFormatter

    for name, values in searched.items():
        metres, colour = np.maximum(np.asarray(values, float), 1.0), colour_of(name)
        tasks = 1 + np.arange(len(metres))
        recent = [np.exp(np.log(metres[max(0, i - RECENT) : i]).mean()) for i in tasks]
        axes.plot(
            tasks, metres, "o", color=colour, alpha=0.4, markersize=4, markeredgecolor=PAPER, markeredgewidth=0.4
        )
        axes.plot(tasks, recent, color=colour, linewidth=width_of(name), zorder=5)
        axes.annotate(
            f"{_WORDS.get(name, name)}\n{recent[-1]:,.0f} m", (tasks[-1], recent[-1]), (6, 0),
            textcoords="offset points", va="center", color=colour, fontsize=8,
        )  # fmt: skip
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    axes.set_title("Hidden goals: metres searched")
    axes.set(xlabel=f"task (points), geometric mean of the last {RECENT} (lines)")
    draw_task_axis(axes, 1 + np.arange(len(np.asarray(next(iter(searched.values()))))))
    axes.grid(axis="y")
