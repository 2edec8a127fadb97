"""One task of Pacman, returns by episode of reuse and of learners, and the episodes each needs (Figure 4.8)."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.domains.pacman.pacman import PacmanMaze, PacmanTask
from lifelore.domains.pacman.picture import draw_pacman
from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, Axes, Figure, house_style, new_figure
from reproduction.chapter4.c4_04_pacman.pacman_library import GREATEST
from reproduction.engine.curve_blocks import block_centres

CURVES = {"Q-learning": ("q", GREY), "PRQ": ("prq", ORANGE), "BPR, sampling the belief": ("bpr", BLUE)}
BARS = (
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


def draw(result: Mapping) -> Figure:
    settings, rows = result["settings"], result["rows"]
    tasks = [row for row in rows if "task_of" in row]
    maze = PacmanMaze(settings["rows"], settings["columns"])
    task = PacmanTask(maze, tuple(rows[0]["foods"]), "clockwise")
    with house_style():
        figure = new_figure(10.6, 4.3)
        left, middle, right = figure.subplots(1, 3, width_ratios=[0.62, 1.25, 0.9])
        # Half a turn on: the ghost is out of sight at first.
        left.imshow(draw_pacman(task, int(task.starts[len(task.starts) // 8])))
        left.set_axis_off()
        left.set_title("A task, the ghost unseen")
        _draw_returns(middle, rows, result["measured"]["library_return"]["value"])
        _draw_needed(right, tasks, settings["episodes"])
        figure.supxlabel(
            f"{len(tasks)} tasks, four ghosts on each of {settings['layouts']} layouts; shaded: one standard "
            "deviation over tasks. BPR and PRQ are given four policies trained on\nthe same foods "
            f"({settings['training_episodes']:,} episodes each), BPR also {settings['samples']} returns of each "
            "against each ghost; Q-learning nothing. Right: median, middle half.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_returns(axes: Axes, rows: Sequence[Mapping], best: float) -> None:
    edges = next(row["curve_edges"] for row in rows if "curve_edges" in row)
    found = {row["curve_of"]: row for row in rows if "curve_of" in row}
    series = {label: found[name] for label, (name, _) in CURVES.items()}
    looks = {label: {"color": colour} for label, (_, colour) in CURVES.items()}
    draw_curves(
        axes, block_centres(edges), series, looks=looks, logarithmic="x", level=(best, "the library's best"),
        legend=False, title="Returns of episodes", xlabel="episode", ylabel="return",
    )  # fmt: skip
    axes.set(xlim=(1, edges[-1]), ylim=(-130, GREATEST + 35))
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower right")


def _draw_needed(axes: Axes, tasks: Sequence[Mapping], most: int) -> None:
    for place, (kind, name, colour, _) in enumerate(BARS):
        low, mid, high = np.quantile([task[kind][name] or most for task in tasks], [0.25, 0.5, 0.75])
        axes.plot([low, high], [place, place], color=colour, lw=5, alpha=0.3, solid_capstyle="butt")
        axes.plot([mid], [place], "o", color=colour, ms=6, alpha=0.45 if kind == "greedy" else 1.0)
        words = f"≥ {mid:,.0f}" if mid >= most else f"{mid:,.0f}"
        axes.annotate(
            words, (mid, place), (0, 5), textcoords="offset points", ha="center", fontsize=6.5, color=INK
        )
    axes.set(xscale="log", xlim=(0.8, most * 1.6), xlabel="episodes needed", title="To within 5 % of the best")
    axes.set_yticks(range(len(BARS)), [label for *_, label in BARS], fontsize=7.5)
    axes.invert_yaxis()
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(axis="x", color=LIGHT)
