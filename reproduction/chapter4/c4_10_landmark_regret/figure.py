"""Regret of landmarks: the example that reaches 2 ε, and how many tasks cost how much."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, INK, ORANGE, VERMILION, Axes
from reproduction.chapter4.c4_10_landmark_regret.run import BINS, EXAMPLE
from reproduction.figures.panels import panels


@panels(8.4, 3.4, 1, 2, width_ratios=[0.8, 1.2], grid="")
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """The example on the left; on the right the share of tasks that cost more than so many ε."""
    _draw_example(left)
    edges = np.linspace(0, 2, BINS + 1)[1:]
    for row, colour in zip(result["rows"], (ORANGE, BLUE), strict=True):
        counts = np.array(row["counts"], float)
        right.plot(
            edges, 100 * (1 - counts.cumsum() / counts.sum()), color=colour, label=f"{row['family']} tables"
        )
    right.axvline(1, color=INK, lw=0.8, ls=":")
    right.annotate("printed bound: ε", (1, right.get_ylim()[1]), (4, -8), textcoords="offset points", fontsize=8)
    right.set(xlim=(0, 2), ylim=(0, None), xlabel="regret (ε)", ylabel="tasks that cost more (%)")
    right.set_title("The worst member as landmark")
    right.grid(axis="y")
    right.legend()


def _draw_example(axes: Axes) -> None:
    landmark, task = EXAMPLE
    for policy, colour in enumerate((BLUE, VERMILION)):
        axes.plot([0, 1], [landmark[policy], task[policy]], "o-", color=colour)
        axes.text(1.12, task[policy], f"policy {'AB'[policy]}", color=colour, va="center")
    axes.annotate("", (0.82, max(task)), (0.82, min(task)), arrowprops={"arrowstyle": "<->", "color": INK})
    axes.text(0.78, sum(task) / 2 - 0.35, "2 ε", ha="right", va="center")
    axes.text(-0.1, landmark[0], "A and B\nalike", ha="right", va="center", color=GREY)
    axes.set_xticks([0, 1], ["landmark", "task"])
    axes.set(xlim=(-0.75, 1.75), ylim=(min(task) - 0.4, max(task) + 0.4))
    axes.set(ylabel="utility", title="Two tasks within ε = 1")
