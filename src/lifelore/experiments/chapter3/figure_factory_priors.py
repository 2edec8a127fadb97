"""Figure of claim C3.4: learning with each make of prior, what the learnt one has taken up, and the grid."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.domains.factory.layout import factory
from lifelore.experiments.chapter3.factory_floor import draw_factory_prior
from lifelore.experiments.chapter3.reward_curves import schedule_in_words
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.learning_curve import draw_curve, draw_optimal
from lifelore.figures.style import GREY, LIGHT, colour_of, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ENCODINGS = {
    "global": "stage of every component",
    "left": "what is left to do",
    "listed": "stages in the list's order",
    "phase": "procuring or assembling",
}
"""Encodings of a configuration as people read them."""
_HAND_MADE = ("expert", "incorrect")


def draw_factory_priors(result: Mapping) -> "Figure":
    """The figure from the result of C3.4."""
    with house_style():
        figure = new_figure(11.6, 9.0)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1.0, 0.98], hspace=0.02)[:, 0]
        curves, raw, procured = upper.subplots(1, 3, width_ratios=[1.2, 0.95, 0.95])
        masses, grid = lower.subplots(1, 2, width_ratios=[0.8, 1.5])
        _draw_curves(curves, result)
        drawn = next(row["drawn"] for row in result["rows"] if "drawn" in row)
        for axes, name in ((raw, "raw"), (procured, "procured")):
            draw_factory_prior(axes, factory(), drawn[name], drawn["components"])
        raw.set_title("The learnt prior, nothing procured")
        procured.set_title("… and all procured (grey: no counts)")
        upper.legend(*curves.get_legend_handles_labels(), loc="outside upper left", ncols=4)
        _draw_masses(masses, result)
        _draw_grid(grid, result)
        lower.supxlabel(_caption(result["settings"]), fontsize=8, color=GREY)
    return figure


def _caption(settings: Mapping) -> str:
    default = settings["default"]
    n = settings["training_tasks"]
    return (
        f"Learnt: from the exact policies of {n} random tasks, by the code of the items' configuration. Expert "
        f"and incorrect: told the two areas, as firmly as {n} policies would.\n"
        f"Default: {schedule_in_words(default['schedule'])}; ties {default['ties']}; α⁰ {default['alpha0']:g}; "
        f"configurations by the {ENCODINGS[default['encoding']]}. Early: the first {settings['early']} episodes, "
        f"of {settings['max_steps']} steps at most.\n"
        f"Shaded, thin lines: 95 % interval over {settings['runs']} runs. Bold: the interval excludes 1."
    )


def _draw_curves(axes: "Axes", result: Mapping) -> None:
    edges = next(row["curve_edges"] for row in result["rows"] if "curve_edges" in row)
    middle = np.sqrt((np.array(edges[:-1]) + 1) * np.array(edges[1:]))
    for row in result["rows"]:
        if "curve_of" in row:
            name = "q-learning" if row["curve_of"] == "uniform" else row["encoding"] or row["curve_of"]
            draw_curve(axes, middle, row["mean"], (row["low"], row["high"]), name, _label(row))
    draw_optimal(axes, result["measured"]["optimal_reward"]["value"])
    axes.set(xscale="log", xlabel="episode", ylabel="reward of an episode")
    axes.set_yscale("symlog", linthresh=200, linscale=0.6)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    axes.xaxis.set_major_formatter("{x:g}")
    # Intervals of few runs reach far above what can be earned.
    axes.set_ylim(top=2.5 * result["measured"]["optimal_reward"]["value"])
    axes.set_title("Learning curves at the default")


def _label(row: Mapping) -> str:
    if row["encoding"]:
        return f"learnt, {ENCODINGS[row['encoding']]}"
    return "uniform (Q-learning)" if row["curve_of"] == "uniform" else row["curve_of"]


def _draw_masses(axes: "Axes", result: Mapping) -> None:
    """A line for each invariance, a mark for each make of prior."""
    found = {(row["mass_on"], row["of"]): row["mass"] for row in result["rows"] if "mass_on" in row}
    names = list(dict.fromkeys(name for name, _ in found))
    makes = ["uniform", *_HAND_MADE, *result["settings"]["encodings"]]
    for i, name in enumerate(names):
        axes.axhline(-i, color=LIGHT, linewidth=0.8, zorder=0)
        for j, make in enumerate(makes):
            colour, place = colour_of("q-learning" if make == "uniform" else make), -i + 0.3 - 0.1 * j
            number = found[name, make]
            axes.plot(number["value"], place, "o", color=colour, markersize=5)
            if number["ci95"]:
                axes.plot(number["ci95"], [place] * 2, color=colour, linewidth=1.2)
            among = found.get((name, f"{make}, seen"))
            if among:
                axes.plot(among["value"], place, "o", color=colour, markersize=5, fillstyle="none")
    signs = {"wall moves": "less", "uses elsewhere": "less"}
    axes.set_yticks([-i for i in range(len(names))], [f"{n}\n({signs.get(n, 'more')} is right)" for n in names])
    axes.set(xlim=(-0.02, 1.02), ylim=(-len(names) + 0.45, 0.55), xlabel="mass of the prior")
    axes.tick_params(axis="y", length=0)
    axes.set_title("Invariances; open: where it has counts")


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    cells = {_key(row): row for row in result["rows"] if "loss_ratio" in row}
    makes = [(name, None) for name in _HAND_MADE] + [("learnt", one) for one in settings["encodings"]]
    sides = [(prior, encoding, alpha0) for prior, encoding in makes for alpha0 in settings["alpha0"]]
    columns = [(schedule, ties) for schedule in settings["schedules"] for ties in settings["ties"]]
    numbers = [
        [cells[(*side, ties, tuple(schedule))]["loss_ratio"] for schedule, ties in columns] for side in sides
    ]
    draw_heat_grid(
        axes,
        [[number["value"] for number in row] for row in numbers],
        [[_excludes_one(number["ci95"]) for number in row] for row in numbers],
        [f"{encoding or prior}, α⁰ {alpha0:g}" for prior, encoding, alpha0 in sides],
        [f"{_brief(schedule)}\nties {ties}" for schedule, ties in columns],
        neutral=1.0, spread=8.0, ratio=True, good="low", words="{:.2f}".format,
        outlined=(
            sides.index(("learnt", default["encoding"], default["alpha0"])),
            columns.index((default["schedule"], default["ties"])),
        ),
    )  # fmt: skip
    axes.set_title("Loss against optimal in the early episodes, as a ratio to Q-learning's")


def _key(row: Mapping) -> tuple:
    return (row["prior"], row["encoding"], row["alpha0"], row["ties"], tuple(row["schedule"]))


def _brief(schedule: Sequence[float]) -> str:
    first, decay, _ = schedule
    return f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}"


def _excludes_one(interval: Sequence[float] | None) -> bool:
    return bool(interval) and not interval[0] <= 1 <= interval[1]
