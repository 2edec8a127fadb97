"""Figure of claim C4.4: one task, returns by episode of reuse and of learners, and the episodes each needs."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.domains.pacman.pacman import PacmanMaze, PacmanTask
from lifelore.domains.pacman.picture import draw_pacman
from lifelore.experiments.chapter4.c4_04_pacman.pacman_library import GREATEST
from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_pacman_reuse(result, greatest=GREATEST)


_CURVES = {"q": (GREY, "Q-learning"), "prq": (ORANGE, "PRQ"), "bpr": (BLUE, "BPR, sampling the belief")}
_BARS = (
    ("needed", "bpr", BLUE, "BPR, sampling"),
    ("needed", "bpr_ei", BLUE, "… expected improvement"),
    ("needed", "bpr_more", BLUE, "… models of more samples"),
    ("needed", "bpr_exact", BLUE, "… exact moments"),
    ("needed", "prq", ORANGE, "PRQ"),
    ("needed", "prq_scaled", ORANGE, "… returns in [0, 1]"),
    ("needed", "prq_scaled_discounted", ORANGE, "… and discounted"),
    ("greedy", "prq", ORANGE, "PRQ's greedy policy"),
    ("needed", "q", GREY, "Q-learning"),
    ("needed", "q_discounted", GREY, "… discounted"),
    ("greedy", "q", GREY, "Q-learning's greedy policy"),
)


def draw_pacman_reuse(result: Mapping, greatest: float) -> "Figure":
    """The figure from the result of C4.4; `greatest` is the return of an episode that is won."""
    settings = result["settings"]
    n_tasks = sum("task_of" in row for row in result["rows"])
    with house_style():
        figure = new_figure(10.6, 4.3)
        left, middle, right = figure.subplots(1, 3, width_ratios=[0.62, 1.25, 0.9])
        _draw_task(left, settings, result["rows"][0]["foods"])
        _draw_curves(middle, result, greatest)
        _draw_needed(right, result["rows"], settings["episodes"])
        figure.supxlabel(
            f"{n_tasks} tasks, four ghosts on each of {settings['layouts']} layouts; shaded: one standard "
            "deviation over tasks. BPR and PRQ are given four policies trained on\nthe same foods "
            f"({settings['training_episodes']:,} episodes each), BPR also {settings['samples']} returns of each "
            "against each ghost; Q-learning nothing. Right: median, middle half.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_task(axes: "Axes", settings: Mapping, foods: Sequence[int]) -> None:
    task = PacmanTask(PacmanMaze(settings["rows"], settings["columns"]), tuple(foods), "clockwise")
    # Half a turn on: where the ghost is out of sight at first.
    axes.imshow(draw_pacman(task, int(task.starts[len(task.starts) // 8])))
    axes.set_axis_off()
    axes.set_title("A task, the ghost unseen")


def _draw_curves(axes: "Axes", result: Mapping, greatest: float) -> None:
    edges = next(row["curve_edges"] for row in result["rows"] if "curve_edges" in row)
    middle = np.sqrt((np.array(edges[:-1]) + 1) * np.array(edges[1:]))
    found = {row["curve_of"]: row for row in result["rows"] if "curve_of" in row}
    for name, (colour, label) in _CURVES.items():
        mean, spread = (np.array(found[name][key]) for key in ("mean", "deviation"))
        axes.fill_between(middle, mean - spread, mean + spread, color=colour, alpha=0.15, lw=0)
        axes.plot(middle, mean, color=colour, label=label)
    best = result["measured"]["library_return"]["value"]
    axes.axhline(best, color=INK, ls=(0, (1, 2)), lw=1.2, label="the library's best")
    axes.set(xscale="log", xlim=(1, edges[-1]), ylim=(-130, greatest + 35), xlabel="episode", ylabel="return")
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower right")
    axes.set_title("Returns of episodes")


def _draw_needed(axes: "Axes", rows: Sequence[Mapping], most: int) -> None:
    tasks = [row for row in rows if "task_of" in row]
    for place, (kind, name, colour, _) in enumerate(_BARS):
        needed = np.array([task[kind][name] or most for task in tasks], float)
        low, mid, high = np.quantile(needed, [0.25, 0.5, 0.75])
        pale = 0.45 if kind == "greedy" else 1.0
        axes.plot([low, high], [-place, -place], color=colour, lw=5, alpha=0.3, solid_capstyle="butt")
        axes.plot([mid], [-place], "o", color=colour, ms=6, alpha=pale)
        axes.annotate(
            f"≥ {mid:,.0f}" if mid >= most else f"{mid:,.0f}", (mid, -place), (0, 5),
            textcoords="offset points", ha="center", fontsize=6.5, color=INK,
        )  # fmt: skip
    axes.set(xscale="log", xlim=(0.8, most * 1.6), xlabel="episodes needed")
    axes.set_yticks(-np.arange(len(_BARS)), [label for *_, label in _BARS], fontsize=7.5)
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(axis="x", color=LIGHT)
    axes.set_title("To within 5 % of the best")
