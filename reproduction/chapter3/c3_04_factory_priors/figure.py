"""Figure of claim C3.4: learning with each prior, the invariances that the learnt prior has, and the grid."""

from collections.abc import Mapping

import numpy as np

from lifelore.domains.factory.layout import factory
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import (
    GREY,
    LIGHT,
    Axes,
    Figure,
    colour_of,
    house_style,
    new_figure,
    two_rows,
    width_of,
)
from reproduction.chapter3.c3_04_factory_priors.factory_floor import draw_factory_prior
from reproduction.chapter3.c3_04_factory_priors.run import ADVICE
from reproduction.chapter3.factory.learning import ENCODINGS, LEARNT, PLAIN
from reproduction.chapter3.figures.choice_grid import RATIO, draw_choice_grid
from reproduction.chapter3.figures.reward_curves import curve_edges
from reproduction.chapter3.learning.schedules import schedule_in_words
from reproduction.engine.curve_blocks import block_centres


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings = result["settings"]
    figure = new_figure(11.6, 9.0)
    upper, lower = two_rows(figure, (1.0, 0.98))
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
    cells = [row for row in result["rows"] if "loss_ratio" in row and row["prior"] != PLAIN]
    draw_choice_grid(
        grid, {**settings, "default": {**settings["default"], "prior": LEARNT}}, cells, "loss_ratio",
        ("prior", "encoding", "alpha0"), lambda prior, code, alpha0: f"{code or prior}, α⁰ {alpha0:g}",
        **{**RATIO, "spread": 8.0},
    )  # fmt: skip
    grid.set_title("Loss against optimal in the early episodes, as a ratio to Q-learning's")
    lower.supxlabel(_caption(settings), fontsize=8, color=GREY)
    return figure


def _caption(settings: Mapping) -> str:
    default, n = settings["default"], settings["training_tasks"]
    return (
        f"Learnt: from the exact policies of {n} random tasks, by the code of the items' configuration. Expert "
        f"and incorrect: the two areas as advice, which counts as much as {n} policies.\n"
        f"Default: {schedule_in_words(default['schedule'])}; ties {default['ties']}; α⁰ {default['alpha0']:g}; "
        f"configurations by the {ENCODINGS[default['encoding']]}. Early: the first {settings['early']} episodes, "
        f"of {settings['max_steps']} steps at most. Curves without a band: learnt on.\n"
        f"Shaded, thin lines: 95 % interval over {settings['runs']} runs. The table, by ε and ties: bold where "
        "the interval excludes 1; framed: the default."
    )


def _draw_curves(axes: Axes, result: Mapping) -> None:
    series, looks = {}, {}
    for row in (row for row in result["rows"] if "curve_of" in row):
        name = row["encoding"] or ("q-learning" if row["curve_of"] == PLAIN else row["curve_of"])
        label = f"learnt, {ENCODINGS[name]}" if name in ENCODINGS else name
        label = label.replace("q-learning", "uniform (Q-learning)")
        series[label] = row
        looks[label] = {"color": colour_of(name), "linewidth": width_of(name), "zorder": 10 - width_of(name)}
    optimal = result["measured"]["optimal_reward"]["value"]
    draw_curves(
        axes, block_centres(curve_edges(result)), series, looks=looks, title="Learning curves at the default",
        xlabel="episode", ylabel="reward of an episode", logarithmic="x", level=(optimal, "optimal"), legend=False,
    )  # fmt: skip
    for row in (row for row in result["rows"] if "learnt_on" in row):
        name = {PLAIN: "q-learning", LEARNT: result["settings"]["default"]["encoding"]}.get(row["learnt_on"])
        centres, rewards = block_centres([0, *row["stages"]]), np.array(row["rewards"])
        later = np.array([0, *row["stages"][:-1]]) >= result["settings"]["episodes"]
        axes.plot(centres[later], rewards[later], color=colour_of(name or row["learnt_on"]), linewidth=1.2)
    axes.set_yscale("symlog", linthresh=200, linscale=0.6)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    axes.xaxis.set_major_formatter("{x:g}")
    # Intervals of few runs reach far above what can be earned.
    axes.set_ylim(top=2.5 * optimal)


def _draw_masses(axes: Axes, result: Mapping) -> None:
    """A line for each invariance, a mark for each prior."""
    found = {(row["mass_on"], row["of"]): row["mass"] for row in result["rows"] if "mass_on" in row}
    names = list(dict.fromkeys(name for name, _ in found))
    for i, name in enumerate(names):
        axes.axhline(-i, color=LIGHT, linewidth=0.8, zorder=0)
        for j, prior in enumerate([PLAIN, *ADVICE, *result["settings"]["encodings"]]):
            colour, place = colour_of("q-learning" if prior == PLAIN else prior), -i + 0.3 - 0.1 * j
            number = found[name, prior]
            axes.plot(number["value"], place, "o", color=colour, markersize=5)
            if number["ci95"]:
                axes.plot(number["ci95"], [place] * 2, color=colour, linewidth=1.2)
            among = found.get((name, f"{prior}, seen"))
            if among:
                axes.plot(among["value"], place, "o", color=colour, markersize=5, fillstyle="none")
    signs = {"wall moves": "less", "uses elsewhere": "less"}
    axes.set_yticks([-i for i in range(len(names))], [f"{n}\n({signs.get(n, 'more')} is right)" for n in names])
    axes.set(xlim=(-0.02, 1.02), ylim=(-len(names) + 0.45, 0.55), xlabel="mass of the prior")
    axes.tick_params(axis="y", length=0)
    axes.set_title("Invariances; open: where it has counts")
