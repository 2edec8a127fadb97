"""Returns of policy reuse, PRQ and Q-learning by episode (Figure 4.8)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import INK, LIGHT, Figure, house_style, new_figure
from reproduction.chapter4.reuse.looks import look_of


@house_style()
def draw(result: Mapping) -> Figure:
    """Means of twenty tasks, one standard deviation shaded."""
    *curves, level = result["rows"]
    figure = new_figure(7.2, 3.9)
    axes = figure.subplots()
    episodes = (np.arange(len(curves[0]["mean"])) + 0.5) * result["settings"]["episodes"] / len(curves[0]["mean"])
    for row in curves:
        mean, deviation, look = np.array(row["mean"]), np.array(row["deviation"]), look_of(row["method"])
        axes.fill_between(episodes, mean - deviation, mean + deviation, color=look["color"], alpha=0.15, lw=0)
        axes.plot(episodes, mean, label=row["method"], **look)
    axes.axhline(level["best"], color=INK, ls=":", lw=1, label="library's best")
    axes.set(xlim=(0, result["settings"]["episodes"]), xlabel="episode", ylabel="return")
    axes.set_title(f"Pacman, {curves[0]['tasks']} tasks")
    axes.grid(axis="y", color=LIGHT)
    figure.legend(loc="outside right upper")
    return figure
