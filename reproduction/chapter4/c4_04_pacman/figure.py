"""The maze, and returns of policy reuse, PRQ and Q-learning by episode (Figures 4.7 and 4.8)."""

from collections.abc import Mapping

import numpy as np

from lifelore.domains.pacman.pacman import PacmanMaze, PacmanTask
from lifelore.figures.style import INK, Axes
from reproduction.chapter4.c4_04_pacman.picture import draw_pacman
from reproduction.chapter4.reuse.looks import look_of
from reproduction.figures.panels import panels


@panels(9.4, 3.9, 1, 2, width_ratios=[0.62, 1.38], grid="")
def draw(result: Mapping, left: Axes, axes: Axes) -> None:
    """A task, the ghost in sight or not; means of twenty tasks, one standard deviation shaded."""
    (*curves, level), settings = result["rows"], result["settings"]
    task = PacmanTask(PacmanMaze(settings["rows"], settings["columns"]), tuple(level["foods"]), "clockwise")
    left.imshow(draw_pacman(task, int(task.starts[0])))
    left.set_axis_off()
    left.set_title("A task")
    episodes = (np.arange(len(curves[0]["mean"])) + 0.5) * settings["episodes"] / len(curves[0]["mean"])
    for row in curves:
        mean, deviation, look = np.array(row["mean"]), np.array(row["deviation"]), look_of(row["method"])
        axes.fill_between(episodes, mean - deviation, mean + deviation, color=look["color"], alpha=0.15, lw=0)
        axes.plot(episodes, mean, label=row["method"], **look)
    axes.axhline(level["best"], color=INK, ls=":", lw=1, label="library's best")
    axes.set(xlim=(0, settings["episodes"]), xlabel="episode", ylabel="return")
    axes.set_title(f"Pacman, {curves[0]['tasks']} tasks")
    axes.grid(axis="y")
    axes.figure.legend(loc="outside right upper")
