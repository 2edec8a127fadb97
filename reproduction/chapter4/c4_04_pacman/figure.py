"""Returns of policy reuse, PRQ and Q-learning by episode (Figure 4.8)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import Axes
from reproduction.chapter4.reuse.looks import look_of
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels


@panels(7.2, 3.9)
def draw(result: Mapping, axes: Axes) -> None:
    """Means of twenty tasks, one standard deviation shaded."""
    (*curves, level), episodes = result["rows"], result["settings"]["episodes"]
    points = len(curves[0]["mean"])
    draw_curves(
        axes, (np.arange(points) + 0.5) * episodes / points, {row["method"]: row for row in curves},
        looks={row["method"]: look_of(row["method"]) for row in curves}, xlabel="episode", ylabel="return",
        title=f"Pacman, {curves[0]['tasks']} tasks", level=(level["best"], "library's best"), legend=False,
    )  # fmt: skip
    axes.set_xlim(0, episodes)
    axes.figure.legend(loc="outside right upper")
