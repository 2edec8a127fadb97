"""C3.9, and C3.10: thirty tasks in modified factories, with all ten features and with features chosen anew.

Kept of each task: rewards of the first and the last episode, by the prior in use, and the features chosen.
Thesis: §3.3.3, Alg. 6, §3.4.6, Figures 3.13 and 3.14.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.figures.style import BLUE, GREY, PURPLE, Axes
from reproduction.chapter3.factory import comparison
from reproduction.chapter3.factory.comparison import UNIFORM
from reproduction.chapter3.factory.modified_tasks import FULL_SET, problem_of
from reproduction.chapter3.factory.online_selection import FULL, SELECTED, OnlineAgent
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Cell, Grid
from reproduction.engine.learning_run import learnt
from reproduction.engine.records import Record, curve_of, nested, values_of
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

METHODS = (UNIFORM, FULL, SELECTED)
PARTS = ("first", "last")
DRAWN = 10
"""Runs in the figures, as many as in the thesis's; numbers rest on all runs."""
PAIRS = {
    "first_selected_minus_full": (SELECTED, FULL, "first"),
    "first_full_minus_uniform": (FULL, UNIFORM, "first"),
    "last_full_minus_uniform": (FULL, UNIFORM, "last"),
    "last_selected_minus_uniform": (SELECTED, UNIFORM, "last"),
}
shared = (
    "discount", "components", "tasks", "episodes", "learning_rate", "source", "schedule", "ties", "max_steps",
    "alpha0",
)  # fmt: skip


def grid_of(settings: Mapping) -> Grid:
    """The grid: whose policies count × schedules, every other choice alone."""
    return comparison.grid_of(settings, ("source", "schedule"), ("ties", "max_steps", "alpha0"))


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: a series of tasks of every method in every cell of the grid."""
    grid = grid_of(settings)
    found = [
        {"method": method, **how, "first": [], "last": [], "chosen": []}
        for method in METHODS
        for how in grid.cells_of(method)
    ]
    agents = [
        None
        if how["method"] == UNIFORM
        else OnlineAgent(how["method"] == SELECTED, how["source"], how["alpha0"], how["ties"])
        for how in found
    ]
    optimal = []
    for i in range(settings["tasks"]):
        problem = problem_of(settings, (seed, "C3.9", cell["run"], i))
        optimal.append(problem.optimal)
        for series, agent in zip(found, agents, strict=True):
            schedule = schedule_of({**settings, "max_steps": series["max_steps"]}, series["schedule"])
            plain = (problem.tables, problem.stream, None, schedule)
            curve = agent.learn(problem, schedule) if agent else learnt(*plain)[0]
            series["first"].append(float(curve.rewards[0]))
            series["last"].append(float(curve.rewards[-1]))
            series["chosen"].append(mask_of(agent.chosen) if agent else 0)
    return {**cell, "optimal": optimal, "found": found}


def mask_of(names: Sequence[str]) -> int:
    """Chosen features as a number: bit i is set where the i-th of φ4 is chosen."""
    return sum(1 << i for i, name in enumerate(FULL_SET.names) if name in names)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
    """The comparisons in every cell of the grid."""
    grid, series = grid_of(settings), nested(results, "found")
    for cell in grid.cells:
        yield cell, _numbers(results, grid, series, cell)


def _numbers(
    results: Sequence[Mapping], grid: Grid, series: Sequence[Record], cell: Mapping
) -> dict[str, Estimate]:
    """Differences of rewards as shares of the distance from no prior's first episode to the optimum."""

    def mean(method: str, part: str) -> NDArray[np.float64]:
        """Over the tasks after the first, in which nobody has a prior; (n_runs,)."""
        return values_of(series, part, **grid.where(method, cell))[:, 1:].mean(axis=1)

    distance = np.array([np.mean(result["optimal"][1:]) for result in results]) - mean(UNIFORM, "first")
    return {
        name: ratio_estimate(mean(ours, part) - mean(theirs, part), distance)
        for name, (ours, theirs, part) in PAIRS.items()
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean reward and its standard deviation in the first and the last episode of each task, by method."""
    grid, series = grid_of(settings), nested(results[:DRAWN], "found")
    return [
        {
            "curve_of": method,
            "part": part,
            **curve_of(values_of(series, part, **grid.where(method, grid.default))),
        }
        for part in PARTS
        for method in METHODS
    ]


LOOKS = {
    "uniform": ("uniform prior", GREY),
    "full": ("all ten features", PURPLE),
    "selected": ("selected features", BLUE),
}
DASHES = {"first": "-", "last": (0, (4, 2))}


@panels(6.8, 4.4, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """Figure of claim C3.9: reward in the first and the last episode of each task.

    Two bundles of lines: first episodes, and the last ones above them.
    """
    settings, series, looks = result["settings"], {}, {}
    for row in result["rows"]:
        words, colour = LOOKS[row["curve_of"]]
        label = f"{words}, episode {1 if row['part'] == 'first' else settings['episodes']}"
        # Shades of both bundles would hide one another.
        series[label] = row if row["part"] == "first" else {"mean": row["mean"]}
        looks[label] = {"color": colour, "linewidth": 1.5, "linestyle": DASHES[row["part"]]}
    draw_curves(
        axes, None, series, looks=looks, xlabel="task", ylabel="reward of an episode", legend=False,
    )  # fmt: skip
    lowest = min(np.min(row["mean"]) for row in result["rows"])
    axes.set(xlim=(1, settings["tasks"]), ylim=(1.1 * lowest, -0.06 * lowest))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=2)
    runs = min(DRAWN, settings["runs"])
    axes.figure.supxlabel(
        f"{runs} runs; shaded: one standard deviation of the first episodes.", fontsize=8, color=GREY
    )
