"""Figure of claim C3.16: Q-learning's rewards with advice and without, and where ten episodes are enough."""

from collections.abc import Mapping
from itertools import product

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import GREY, INK, LIGHT, Axes, Figure, house_style, new_figure, two_rows
from reproduction.chapter3.advice.buildings import other_choices
from reproduction.chapter3.advice.figures import (
    ADVISOR_COLOURS,
    EXPERTS_IN_WORDS,
    draw_buildings,
    draw_maze_grid,
)
from reproduction.chapter3.advice.mazes import grid_of
from reproduction.chapter3.figures.reward_curves import curve_edges
from reproduction.chapter3.learning.schedules import schedule_in_brief, schedule_in_words
from reproduction.engine.curve_blocks import block_centres
from reproduction.engine.results_table import ResultsTable

METHODS = {"plain": "without advice", "advised": "with advice"}
LOOKS = {"without advice": {"color": ADVISOR_COLOURS["none"]}, "with advice": {"color": ADVISOR_COLOURS["thesis"]}}
STARTS = {"one": "Every episode of a task starts in one cell", "any": "Episodes start anywhere"}


@house_style()
def draw(result: Mapping) -> Figure:
    """Learning curves by start above, the grid of open choices below."""
    settings = result["settings"]
    figure = new_figure(10.4, 8.0)
    upper, lower = two_rows(figure, (1, 1.3))
    panels = upper.subplots(1, len(settings["starts"]), squeeze=False, sharey=True)[0]
    for axes, starts in zip(panels, settings["starts"], strict=True):
        _draw_starts(axes, result, starts)
    panels[0].set_ylabel("reward of an episode, of 1000")
    panels[-1].legend(loc="lower right")
    grid, beside = lower.subplots(2, 1, height_ratios=(1, 0.25))
    _draw_grid(grid, result)
    _draw_buildings(beside, result)
    lower.supxlabel(
        f"Shaded: one standard deviation over {settings['mazes']} mazes of {settings['tasks']} tasks; curves "
        f"at loops {settings['default']['loops']:g}, {schedule_in_words(settings['default']['schedule'])}. "
        "Framed: the default.\n"
        f"{EXPERTS_IN_WORDS}\nLast table: learners start where the explorers of C3.15 do.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_starts(axes: Axes, result: Mapping, starts: str) -> None:
    edges, series = curve_edges(result), {}
    for row in result["rows"]:
        if "curve_of" in row and row["starts"] == starts:
            mean, spread = np.array(row["mean"]), np.array(row["deviation"])
            band = {"low": np.clip(mean - spread, 0, None), "high": np.clip(mean + spread, None, 1000)}
            series[METHODS[row["curve_of"]]] = {"mean": mean, **band}
    look = {"looks": LOOKS, "title": STARTS[starts], "logarithmic": "x", "legend": False}
    draw_curves(axes, block_centres(edges), series, **look)
    axes.axvline(10, color=INK, lw=0.9, ls=(0, (4, 3)))
    axes.annotate(
        "a handful", (10, 1), (3, -2), xycoords=("data", "axes fraction"), textcoords="offset points",
        va="top", fontsize=7.5, color=GREY,
    )  # fmt: skip
    axes.set(ylim=(0, 1040), xlabel="episode", xlim=(1, edges[-1]))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid(axis="y", color=LIGHT)


def _draw_buildings(axes: Axes, result: Mapping) -> None:
    settings = result["settings"]
    rows = [row for row in result["rows"] if "building" in row]
    in_ten = {(row["building"]["name"], row["alpha0"]): 100 * row["in_ten"] for row in rows}
    choices = [(settings["buildings"][place]["name"], a) for place, a in [(0, 0.0), *other_choices(settings)]]
    pairs = [[(in_ten[name, None], in_ten[name, a]) for name, a in choices]]
    draw_buildings(axes, settings, pairs, ["without → with advice"], neutral=0.0, spread=100.0)
    axes.set_title("Goals found within ten episodes in other buildings, and with α⁰ in the advice (% of tasks)")


def _draw_grid(axes: Axes, result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    rows, keys = (row for row in result["rows"] if "plain" in row), ("loops", "experts", "starts", "schedule")
    cells = ResultsTable(rows, keys)
    uses: list[tuple] = list(product(settings["starts"], settings["schedules"], METHODS))
    values, sides = [], []
    for s, f, m in uses:
        found = [cells.record(loops=n, experts=e, starts=s, schedule=f)[m] for n, e in grid_of(settings)]
        values.append([100 * numbers["in_ten"] for numbers in found])
        sides.append(f"start {s}, {schedule_in_brief(f)}, {METHODS[m]}")
    framed = uses.index((default["starts"], default["schedule"], "advised"))
    title = "Goals found within ten episodes (% of tasks; bold: most)"
    look = {"neutral": 0.0, "spread": 100.0, "words": "{:.0f}".format}
    draw_maze_grid(axes, result, values, np.array(values) > 50, sides, title=title, framed_row=framed, **look)
