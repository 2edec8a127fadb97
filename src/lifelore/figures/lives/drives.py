"""Driven jobs at a glance: the time that a building took, job after job, and what was learnt of its floor."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.lives.floor_plan import draw_floor_plan, draw_scale_bar, tint
from lifelore.figures.style import (
    INK,
    LIGHT,
    ORANGE,
    PAPER,
    VERMILION,
    colour_of,
    house_style,
    new_figure,
    width_of,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SLOWEST = 3.0
"""Delay, as a factor of the nominal time, of the darkest colour."""
_WORDS = {"lore": "with memory", "map only": "on the map alone"}
"""Words for agents in the legend."""


class LearntFloor(NamedTuple):
    """What was learnt of a building.

    shape, cells, neighbour : as in `draw_floor_plan`
    delay : (n,) expected time in each cell as a factor of the nominal time; NaN where nothing was observed
    refused : (m, 2) row and column of cells that were refused
    cell : side of a cell in metres
    """

    shape: tuple[int, int]
    cells: NDArray
    neighbour: NDArray
    delay: NDArray[np.float64]
    refused: NDArray
    cell: float


def draw_drives(
    jobs: ArrayLike, agents: Mapping[str, Mapping[str, ArrayLike]], floor: LearntFloor, *, title: str = ""
) -> "Figure":
    """The time that each agent lost, added up, beside the floor as it was learnt.

    Parameters
    ----------
    jobs : (n,) int
        Numbers of the jobs.
    agents : mapping
        Agent's name to ``lost``, (n,) seconds, and ``refusals``, (n,) int.
    floor : LearntFloor
    title : str
    """
    with house_style():
        figure = new_figure(11.0, 4.8)
        left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
        draw_lost_time(left, jobs, agents)
        draw_learnt_floor(right, floor)
        figure.suptitle(title, x=0.01, ha="left")
    return figure


def draw_lost_time(axes: "Axes", jobs: ArrayLike, agents: Mapping[str, Mapping[str, ArrayLike]]) -> None:
    """Minutes lost, added up over jobs; a mark for each job in which a move was refused."""
    jobs = np.asarray(jobs)
    for name, of in agents.items():
        minutes = (np.cumsum(np.asarray(of["lost"], float)) / 60).round(2) + 0.0  # no -0
        refused = np.asarray(of["refusals"]) > 0
        count = int(np.sum(of["refusals"]))
        moves = "1 refused move" if count == 1 else f"{count} refused moves"
        colour = colour_of(name)
        axes.plot(jobs, minutes, color=colour, linewidth=width_of(name), zorder=5)
        axes.plot(
            jobs[refused], minutes[refused], "X", color=colour, markersize=5.5, markeredgecolor=PAPER,
            markeredgewidth=0.7, zorder=6,
        )  # fmt: skip
        lost = round(minutes[-1])
        axes.annotate(
            f"{_WORDS.get(name, name)}\n{lost} min, {moves}", (jobs[-1], minutes[-1]), (6, 0),
            textcoords="offset points", va="center" if minutes[-1] else "bottom", color=colour, fontsize=8,
        )  # fmt: skip
    axes.set_title("Known goals: minutes lost to the building, added up")
    axes.set(xlabel="job (a cross: a move was refused)", ylim=(0, max(axes.get_ylim()[1], 1.0)))
    draw_task_axis(axes, jobs)
    axes.grid(axis="y")


def draw_task_axis(axes: "Axes", tasks: NDArray) -> None:
    """Whole numbers along the tasks, with room for the names of the lines on their right."""
    from matplotlib.ticker import MaxNLocator

    ticks = MaxNLocator(integer=True, nbins=6, min_n_ticks=1).tick_values(tasks.min(), tasks.max())
    axes.set_xticks([tick for tick in ticks if tasks.min() <= tick <= tasks.max()])
    axes.set_xlim(tasks.min() - 0.6, tasks.max() + 0.33 * max(np.ptp(tasks), 1))


def draw_learnt_floor(axes: "Axes", floor: LearntFloor) -> None:
    """The plan, coloured by the expected delay; a cross where a place was refused."""
    share = np.clip((np.nan_to_num(floor.delay, nan=1.0) - 1) / (SLOWEST - 1), 0, 1)
    colours = np.where(np.isnan(floor.delay)[:, None], 1.0, tint((LIGHT, ORANGE, VERMILION), share))
    draw_floor_plan(axes, floor.shape, floor.cells, floor.neighbour, colours=colours)
    if len(floor.refused):
        rows, columns = np.asarray(floor.refused).T
        axes.plot(columns, rows, "X", color=INK, markersize=6, markeredgecolor=PAPER, zorder=6)
    draw_scale_bar(axes, floor.cell)
    axes.set_title("What the drives taught of the floor")
    for colour, words in (
        (LIGHT, "full speed"),
        (ORANGE, "half the speed"),
        (VERMILION, f"1/{SLOWEST:.0f} of it"),
    ):
        axes.plot([], [], "s", color=colour, markersize=8, label=words)
    axes.plot([], [], "X", color=INK, markersize=6, markeredgecolor=PAPER, label="blocked at times")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.01), ncols=4, columnspacing=1.2, handletextpad=0.2)
    axes.set_anchor("N")
