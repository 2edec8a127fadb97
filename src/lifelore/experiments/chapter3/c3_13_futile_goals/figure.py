"""Figure of claim C3.13: Eq. 3.6 against what is measured, and how near worlds as found come to it."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_futile_goals(result)


_COLOURS = (BLUE, ORANGE, GREEN)
_NO_TASK = 0.35
"""Where "no task" stands on the logarithmic axis."""


def draw_futile_goals(result: Mapping) -> "Figure":
    """The figure from the result of C3.13."""
    settings = result["settings"]
    with house_style():
        figure = new_figure(12.0, 4.1)
        states, percepts, found = figure.subplots(1, 3, width_ratios=[1, 1, 1.05])
        default = settings["default"]
        _draw_cases(
            states,
            [r for r in result["rows"] if r.get("alike") == 1 and r["actions"] == default["actions"]],
            "alpha0",
            "α⁰ = {:g}",
        )
        states.set(title=f"By states, {default['actions']} actions", ylabel="probability of the one action")
        chosen = [
            row
            for row in result["rows"]
            if "alike" in row and all(row[key] == value for key, value in default.items())
        ]
        _draw_cases(percepts, chosen, "alike", "|T| · {}")
        percepts.set(title=f"By percepts of 1 or more states, α⁰ = {default['alpha0']:g}")
        _draw_found(found, result)
        figure.supxlabel(
            "Lines: Eq. 3.6, with tasks times states that look alike for percepts. Points: share of "
            f"{settings['draws'] * settings['runs']:,} steps, exact 95 % intervals.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_cases(axes: "Axes", cases: list[Mapping], key: str, words: str) -> None:
    for colour, value in zip(_COLOURS, sorted({case[key] for case in cases}), strict=False):
        line = sorted((case for case in cases if case[key] == value), key=lambda case: case["tasks"])
        x = np.array([case["tasks"] or _NO_TASK for case in line], float)
        measured, low, high = (np.array([case[name] for case in line]) for name in ("measured", "low", "high"))
        axes.plot(x, [case["formula"] for case in line], color=colour, linewidth=1.3, label=words.format(value))
        axes.errorbar(
            x, measured, yerr=[measured - low, high - measured], fmt="o", markersize=4, color=colour, linewidth=1
        )
    ticks = sorted({case["tasks"] for case in cases})
    axes.set(xscale="log", yscale="log", xlabel="tasks so far")
    axes.set_xticks([tick or _NO_TASK for tick in ticks], [str(tick) if tick else "none" for tick in ticks])
    axes.minorticks_off()
    axes.grid(color=LIGHT)
    axes.legend()


def _draw_found(axes: "Axes", result: Mapping) -> None:
    """A point for each world: its least probable way into a futile goal, over the bound."""
    worlds = [row for row in result["rows"] if "kind" in row]
    labels = [f"{row['kind']}, {row['tasks']}" for row in worlds]
    for shift, (key, colour, label) in zip(
        (-0.17, 0.17), (("least", BLUE, "by states"), ("least_percepts", ORANGE, "by percepts")), strict=True
    ):
        for place, row in enumerate(worlds):
            values = np.array(row[key])
            spread = (
                shift + np.linspace(-0.1, 0.1, len(values)) if len(values) > 1 else np.full(len(values), shift)
            )
            axes.plot(
                values, place + spread, "o", markersize=2.6, alpha=0.6, color=colour, markeredgewidth=0,
                label=label if place == 0 else None,
            )  # fmt: skip
    axes.axvline(1.0, color=INK, linewidth=1.1, linestyle=(0, (4, 3)))
    axes.set(xscale="log", xlabel="least probability over Eq. 3.6", title="Worlds as found: kind, tasks")
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.legend(loc="lower right", markerscale=2)
