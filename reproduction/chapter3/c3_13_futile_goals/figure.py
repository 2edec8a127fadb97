"""Figure of claim C3.13: Eq. 3.6 against what is measured, and how near worlds as found come to it."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, Axes, Figure, house_style, new_figure
from reproduction.engine.results_table import ResultsTable

COLOURS = (BLUE, ORANGE, GREEN)
NO_TASK = 0.35
"""Place of "no task" on the logarithmic axis."""


@house_style()
def draw(result: Mapping) -> Figure:
    """Constructed worlds by states and by percepts, then worlds as found."""
    settings, default = result["settings"], result["settings"]["default"]
    table = ResultsTable((r for r in result["rows"] if "alike" in r), ("actions", "alike", "alpha0", "tasks"))
    figure = new_figure(12.0, 4.4)
    states, percepts, found = figure.subplots(1, 3, width_ratios=[1, 1, 1.05])
    _draw_cases(states, table.select(alike=1, actions=default["actions"]), "alpha0", "α⁰ = {:g}")
    states.set(title=f"By states, {default['actions']} actions", ylabel="probability of the one action")
    _draw_cases(percepts, table.select(**default), "alike", "|T| · {}")
    percepts.set(title=f"By percepts of 1 or more states, α⁰ = {default['alpha0']:g}")
    _draw_found(found, [row for row in result["rows"] if "kind" in row])
    figure.supxlabel(
        "Lines: Eq. 3.6, with tasks times states that look alike for percepts. Points: share of "
        f"{settings['draws'] * settings['runs']:,} steps, exact 95 % intervals.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_cases(axes: Axes, table: ResultsTable, key: str, words: str) -> None:
    """The formula as a line and the measured frequency as points, for each value of `key`."""
    formulas, looks = {}, {}
    for colour, value in zip(COLOURS, sorted(table.distinct(key)), strict=False):
        line = sorted(table.select(**{key: value}).records, key=lambda case: case["tasks"])
        x = [case["tasks"] or NO_TASK for case in line]
        formulas[words.format(value)] = {"x": x, "mean": [case["formula"] for case in line]}
        looks[words.format(value)] = {"color": colour, "linewidth": 1.3}
        measured, low, high = (np.array([case[name] for case in line]) for name in ("measured", "low", "high"))
        errors = [measured - low, high - measured]
        axes.errorbar(x, measured, yerr=errors, fmt="o", markersize=4, color=colour, linewidth=1)
    draw_curves(axes, None, formulas, looks=looks, xlabel="tasks so far", logarithmic="xy")
    ticks = sorted(table.distinct("tasks"))
    axes.set_xticks([tick or NO_TASK for tick in ticks], [str(tick) if tick else "none" for tick in ticks])
    axes.minorticks_off()
    axes.grid(color=LIGHT)


def _draw_found(axes: Axes, worlds: list[Mapping]) -> None:
    """A point for each world: its least probable way into a futile goal, over the bound."""
    for shift, key, colour, label in (
        (-0.17, "least", BLUE, "by states"), (0.17, "least_percepts", ORANGE, "by percepts")
    ):  # fmt: skip
        values = [value for row in worlds for value in row[key]]
        places = [place + shift + np.linspace(-0.1, 0.1, len(row[key])) for place, row in enumerate(worlds)]
        look = {"markersize": 2.6, "alpha": 0.6, "color": colour, "markeredgewidth": 0}
        axes.plot(values, np.concatenate(places), "o", label=label, **look)
    axes.axvline(1.0, color=INK, linewidth=1.1, linestyle=(0, (4, 3)))
    axes.set(xscale="log", xlabel="least probability over Eq. 3.6", title="Worlds as found: kind, tasks")
    axes.set_yticks(range(len(worlds)), [f"{row['kind']}, {row['tasks']}" for row in worlds])
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2, markerscale=2)
