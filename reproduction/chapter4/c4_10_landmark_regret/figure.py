"""Regret of landmarks: the example that reaches 2 ε, regrets in units of ε, and a reserve parted ever coarser."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT,
    ORANGE,
    PURPLE,
    VERMILION,
    Axes,
    Figure,
    house_style,
    new_figure,
)
from reproduction.chapter4.c4_10_landmark_regret.measure import EXAMPLE
from reproduction.chapter4.c4_10_landmark_regret.run import BINS
from reproduction.engine.results_table import ResultsTable

FAMILY_COLOURS = {"uniform": ORANGE, "smooth": GREEN, "clustered": PURPLE, "surveillance": BLUE}
DASHES = (0, (2, 1.2))


def draw(result: Mapping) -> Figure:
    table = ResultsTable(result["rows"], ("form", "family", "tasks", "layout", "metric")).select(form="pairwise")
    with house_style():
        figure = new_figure(10.5, 3.5)
        left, middle, right = figure.subplots(1, 3, width_ratios=[0.8, 1.2, 1.2])
        _draw_example(left)
        _draw_regrets(middle, table)
        _draw_reserve(right, table.select(family="surveillance", tasks="cells"))
    return figure


def _draw_example(axes: Axes) -> None:
    landmark, task = EXAMPLE
    for policy, colour in enumerate((BLUE, VERMILION)):
        axes.plot([0, 1], [landmark[policy], task[policy]], "o-", color=colour)
        axes.text(1.12, task[policy], f"policy {'AB'[policy]}", color=colour, va="center")
    axes.fill_between([0, 1.0], min(task), max(task), color=LIGHT, zorder=0, lw=0)
    axes.annotate("", (0.82, max(task)), (0.82, min(task)), arrowprops={"arrowstyle": "<->", "color": INK})
    axes.text(0.78, sum(task) / 2 - 0.35, "2 ε", ha="right", va="center")
    axes.text(-0.1, landmark[0], "A and B\nalike", ha="right", va="center", color=GREY)
    axes.set_xticks([0, 1], ["landmark", "task"])
    axes.set(xlim=(-0.75, 1.75), ylim=(min(task) - 0.4, max(task) + 0.4))
    axes.set(ylabel="utility", title="Two tasks within ε = 1")


def _draw_regrets(axes: Axes, table: ResultsTable) -> None:
    """Share of tasks that cost more than so many ε; the worst member as landmark dashed."""
    series, looks = {}, {}
    for family, colour in FAMILY_COLOURS.items():
        own = table.select(family=family).records
        for role, label, line in (("landmark", family, "-"), ("member", f"_{family}", DASHES)):
            if own:
                counts = np.sum([row[role]["counts"] for row in own], axis=0)
                total = counts.sum() + sum(row[role]["none"] for row in own)
                above = np.append(np.cumsum(counts[::-1])[::-1], 0) / total
                series[label] = {"mean": 100 * np.where(above > 0, above, np.nan)}
                looks[label] = {"color": colour, "ls": line}
    edges = np.linspace(0, 2, BINS + 1)
    draw_curves(axes, edges, series, looks=looks, xlabel="regret (ε)", logarithmic="y", legend=False)
    for place, name in ((1, "ε, as printed"), (2, "2 ε")):
        axes.axvline(place, color=INK, lw=0.8, ls=":")
        axes.text(place - 0.02, 115, name, ha="right", va="bottom", fontsize=8)
    axes.plot([], [], color=GREY, ls=DASHES, label="worst member as landmark")
    axes.set(xlim=(0, 2.05), ylim=(3e-4, 100), ylabel="tasks that share a type\nand cost more (%)")
    axes.set_title("Random tables and the reserve's", pad=16)
    axes.grid(True, axis="y")
    axes.legend(loc="lower left")


def _draw_reserve(axes: Axes, table: ResultsTable) -> None:
    """Types and regret by ε in the first layout and metric, cells near a hill as tasks."""
    first = table.records[0]
    own = table.select(layout=first["layout"], metric=first["metric"]).records
    percent = 100 * np.array([row["epsilon"] for row in own])
    parts = {
        "worst task, worst member": ("member", "largest", VERMILION),
        "worst task": ("landmark", "largest", ORANGE),
        "mean": ("landmark", "mean", BLUE),
    }
    series = {name: {"mean": percent * [row[w][key] for row in own]} for name, (w, key, _) in parts.items()}
    looks = {name: {"color": colour, "marker": "o", "ms": 4} for name, (_, _, colour) in parts.items()}
    for times, name in ((1, "ε"), (2, "2 ε")):
        axes.plot(percent, times * percent, color=INK, lw=0.8, ls=":")
        axes.annotate(name, (percent[-1], times * percent[-1]), (4, 0), textcoords="offset points", va="center")
    for row, x in zip(own, percent, strict=True):
        axes.annotate(
            f"{row['types']:.0f}", (x, 0), (0, 4), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="center", fontsize=7.5, color=GREY,
        )  # fmt: skip
    draw_curves(
        axes, percent, series, looks=looks, logarithmic="x", legend=False, ylabel="regret (% of the range)",
        title=f"Surveillance, {first['layout']}: cells near hills",
        xlabel="ε (% of the range of utilities); grey: types",
    )  # fmt: skip
    axes.set_xticks(percent, [f"{x:g}" for x in percent])
    axes.minorticks_off()
    axes.set_ylim(bottom=-9)
    axes.legend(loc="upper left")
