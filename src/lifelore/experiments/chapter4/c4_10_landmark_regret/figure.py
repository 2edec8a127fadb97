"""What landmarks cost: the example that reaches 2 ε, regrets in units of ε, and a reserve parted ever coarser."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter4.c4_10_landmark_regret.landmark_tables import BINS
from lifelore.experiments.chapter4.c4_10_landmark_regret.measure import EXAMPLE
from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT,
    ORANGE,
    PURPLE,
    VERMILION,
    house_style,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_landmark_regret(result["rows"], EXAMPLE, BINS)


FAMILY_COLOURS = {"uniform": ORANGE, "smooth": GREEN, "clustered": PURPLE, "surveillance": BLUE}


def draw_landmark_regret(
    rows: Sequence[Mapping], example: tuple[tuple[float, float], tuple[float, float]], n_bins: int
) -> "Figure":
    """Three panels.

    Parameters
    ----------
    rows : sequence of mapping
        As in the result of C4.10: family, ε as a share of the range, form, types, and under ``landmark`` and
        ``member`` mean, largest, none and counts of regret in ε.
    example : utilities of two policies on the landmark and on another task
    n_bins : int
        Bins of the counts, from 0 to 2 ε.
    """
    with house_style():
        figure = new_figure(10.5, 3.5)
        left, middle, right = figure.subplots(1, 3, width_ratios=[0.8, 1.2, 1.2])
        _draw_example(left, example)
        _draw_regrets(middle, rows, n_bins)
        _draw_reserve(right, rows)
    return figure


def _draw_example(axes: "Axes", example: tuple[tuple[float, float], tuple[float, float]]) -> None:
    for policy, colour in enumerate((BLUE, VERMILION)):
        values = [task[policy] for task in example]
        axes.plot([0, 1], values, "o-", color=colour)
        axes.annotate(
            f"policy {'AB'[policy]}", (1, values[1]), (8, 0), textcoords="offset points", color=colour, va="center"
        )
    landmark, task = example
    axes.fill_between([0, 1.0], min(task), max(task), color=LIGHT, zorder=0, lw=0)
    axes.annotate("", (0.82, max(task)), (0.82, min(task)), arrowprops={"arrowstyle": "<->", "color": INK})
    axes.text(0.78, sum(task) / 2 - 0.35, "2 ε", ha="right", va="center")
    axes.text(-0.1, landmark[0], "A and B\nalike", ha="right", va="center", color=GREY)
    axes.set(
        xlim=(-0.75, 1.75), ylim=(min(task) - 0.4, max(task) + 0.4), xticks=[0, 1], ylabel="utility",
        title="Two tasks within ε = 1",
    )  # fmt: skip
    axes.set_xticklabels(["landmark", "task"])


def _draw_regrets(axes: "Axes", rows: Sequence[Mapping], n_bins: int) -> None:
    """Share of tasks that cost more than so many ε, pairwise types, the worst member as landmark dashed."""
    edges = np.linspace(0, 2, n_bins + 1)
    for family, colour in FAMILY_COLOURS.items():
        own = [row for row in rows if row["family"] == family and row["form"] == "pairwise"]
        for who, line in (("landmark", "-"), ("member", (0, (2, 1.2)))):
            if not own:
                continue
            counts = np.sum([row[who]["counts"] for row in own], axis=0)
            total = counts.sum() + sum(row[who]["none"] for row in own)
            above = np.concatenate([np.cumsum(counts[::-1])[::-1], [0]]) / total
            shown = np.where(above > 0, above, np.nan)
            axes.plot(edges, 100 * shown, color=colour, ls=line, label=family if who == "landmark" else None)
    for place, name in ((1, "ε, as printed"), (2, "2 ε")):
        axes.axvline(place, color=INK, lw=0.8, ls=":")
        axes.annotate(name, (place, 1), (-3, 2), xycoords=("data", "axes fraction"), textcoords="offset points",
                      ha="right", va="bottom", fontsize=8)  # fmt: skip
    axes.plot([], [], color=GREY, ls=(0, (2, 1.2)), label="worst member as landmark")
    axes.set(
        yscale="log",
        xlim=(0, 2.05),
        ylim=(3e-4, 100),
        xlabel="regret (ε)",
        ylabel="tasks that share a type\nand cost more (%)",
    )
    axes.set_title("Random tables and the reserve's", pad=16)
    axes.grid(True, axis="y")
    axes.legend(loc="lower left")


def _draw_reserve(axes: "Axes", rows: Sequence[Mapping]) -> None:
    """Types and regret by ε for layout X, cells near a hill as tasks."""
    own = [row for row in rows if row["family"] == "surveillance" and row["tasks"] == "cells"]
    own = [row for row in own if row["form"] == "pairwise" and (row["layout"], row["metric"]) == _first(own)]
    epsilon = np.array([row["epsilon"] for row in own])
    for who, key, colour, name in (
        ("member", "largest", VERMILION, "worst task, worst member"),
        ("landmark", "largest", ORANGE, "worst task"),
        ("landmark", "mean", BLUE, "mean"),
    ):
        axes.plot(
            100 * epsilon, 100 * epsilon * [row[who][key] for row in own], "o-", color=colour, label=name, ms=4
        )
    for times, name in ((1, "ε"), (2, "2 ε")):
        axes.plot(100 * epsilon, 100 * times * epsilon, color=INK, lw=0.8, ls=":")
        axes.annotate(name, (100 * epsilon[-1], 100 * times * epsilon[-1]), (4, 0), textcoords="offset points",
                      va="center", fontsize=8)  # fmt: skip
    for row in own:
        axes.annotate(f"{row['types']:.0f}", (100 * row["epsilon"], 0), (0, 4), ha="center", fontsize=7.5,
                      xycoords=("data", "axes fraction"), textcoords="offset points", color=GREY)  # fmt: skip
    axes.set(xscale="log", xlabel="ε (% of the range of utilities); grey: types", ylabel="regret (% of the range)")
    axes.set_xticks(100 * epsilon, [f"{100 * share:g}" for share in epsilon])
    axes.minorticks_off()
    axes.set_title(f"Surveillance, {own[0]['layout']}: cells near hills" if own else "")
    axes.set_ylim(bottom=-9)
    axes.legend(loc="upper left")


def _first(rows: Sequence[Mapping]) -> tuple[str, str] | None:
    return (rows[0]["layout"], rows[0]["metric"]) if rows else None
