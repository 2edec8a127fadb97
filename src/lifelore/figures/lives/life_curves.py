"""A life at a glance: what each task cost, task after task, for everybody who lived it."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.figures.style import INK, PAPER, colour_of, house_style, new_figure, width_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


MEASURES = {"steps_to_80": "Steps to 80 % of optimal", "collisions": "Collisions on the way there"}
"""Measure to the title of its panel."""


def draw_life(tasks: ArrayLike, agents: Mapping[str, Mapping[str, ArrayLike]], *, title: str = "") -> "Figure":
    """A panel a measure: a point a task, a line for the running median, a cross where the cap was met.

    Parameters
    ----------
    tasks : (n,) int
        Numbers of the tasks.
    agents : mapping
        Agent's name (a key of `style.COLOURS`) to its `MEASURES`, each (n,), and ``reached``, (n,) bool.
    title : str

    Raises
    ------
    InputError
        An agent's measure has not one value a task.
    """
    tasks = np.asarray(tasks)
    with house_style():
        figure = new_figure(10.4, 4.6)
        row = figure.subplots(1, len(MEASURES))
        for axes, (measure, words) in zip(row, MEASURES.items(), strict=True):
            for name, of in agents.items():
                _draw_agent(axes, tasks, name, np.asarray(of[measure], float), np.asarray(of["reached"], bool))
            _dress(axes, tasks, measure != "steps_to_80")
            axes.set_title(words)
        if not all(np.all(of["reached"]) for of in agents.values()):
            row[0].plot([], [], "x", color=INK, markersize=6, label="not reached by the cap")
        handles, labels = row[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
        figure.suptitle(title, x=0.01, ha="left")
    return figure


def running_median(values: ArrayLike) -> NDArray[np.float64]:
    """Median over a window around each value: of 5, or a twelfth of them if that is more.

    At the start the window narrows, so that the first value is itself: a life's first task is like no other. At
    the end it keeps what lies behind, so that one lucky last task is no trend.
    """
    values = np.asarray(values, float)
    n, most = len(values), max(2, len(values) // 24)
    half = [min(most, i) for i in range(n)]
    return np.array([np.median(values[i - h : i + h + 1]) for i, h in enumerate(half)])


def _draw_agent(axes: "Axes", tasks: NDArray, name: str, values: NDArray, reached: NDArray[np.bool_]) -> None:
    if not len(tasks) == len(values) == len(reached):
        raise InputError(f"{name} must have one value a task, got {len(values)} for {len(tasks)} tasks")
    colour, width = colour_of(name), width_of(name)
    size = float(np.clip(90 / len(tasks), 2.0, 4.5))
    alone = len(tasks) == 1
    axes.plot(
        tasks, running_median(values), "o" if alone else "-", color=colour, label=name,
        linewidth=width, markersize=2 + 2 * width, zorder=10 - width,
    )  # fmt: skip
    for mask, marker in ((reached, "o"), (~reached, "x")):
        if not mask.any():
            continue  # an empty, unclipped line would claim the figure's corner in the layout
        axes.plot(
            tasks[mask], values[mask], marker, color=colour, alpha=0.45 if marker == "o" else 0.95,
            markersize=size if marker == "o" else size + 2, markeredgecolor=PAPER if marker == "o" else colour,
            markeredgewidth=0.3 if marker == "o" else 1.3, zorder=2, clip_on=False,
        )  # fmt: skip


def _dress(axes: "Axes", tasks: NDArray, may_be_zero: bool) -> None:
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    if may_be_zero:
        axes.set_yscale("symlog", linthresh=1, linscale=0.5)
        axes.set_ylim(-0.15, 2 * max(1.0, axes.dataLim.y1))
    else:
        axes.set_yscale("log")
        low, high = axes.get_ylim()
        # A range with at most two powers of ten in it needs other numbers at its ticks.
        shown = "23468" if high < 5 * low else "25" if high < 100 * low else ""
        axes.yaxis.set_minor_formatter(FuncFormatter(lambda value, _: _plain(value, shown)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=8, min_n_ticks=1))
    axes.set(xlim=(tasks.min() - 0.6, tasks.max() + 0.6), xlabel="task (points), running median (lines)")
    axes.grid(axis="y")


def _plain(value: float, first_digits: str) -> str:
    """A number in full if its first digit is among these, else nothing."""
    text = f"{value:,.0f}"
    return text if text[0] in first_digits else ""
