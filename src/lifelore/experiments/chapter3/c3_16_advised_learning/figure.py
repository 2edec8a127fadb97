"""Figure of claim C3.16: Q-learning's rewards with advice and without, and where ten episodes are enough."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.explorer_palette import ADVISORS, EXPERT_NAMES
from lifelore.experiments.chapter3.reward_curves import schedule_in_words
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_advised_learning(result)


_LINES = {"plain": ("none", "without advice"), "advised": ("thesis", "with advice")}
_STARTS = {"one": "Every episode of a task starts in one cell", "any": "Episodes start anywhere"}


def draw_advised_learning(result: Mapping) -> "Figure":
    """The figure from the result of C3.16."""
    settings = result["settings"]
    with house_style():
        figure = new_figure(10.4, 6.9)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1, 0.95], hspace=0.02)[:, 0]
        panels = upper.subplots(1, len(settings["starts"]), squeeze=False, sharey=True)[0]
        for axes, starts in zip(panels, settings["starts"], strict=True):
            _draw_curves(axes, result, starts)
        panels[0].set_ylabel("reward of an episode, of 1000")
        panels[-1].legend(loc="lower right")
        _draw_grid(lower.subplots(), result)
        lower.supxlabel(
            f"Shaded: one standard deviation over {settings['mazes']} mazes of {settings['tasks']} tasks; curves "
            f"at loops {settings['default']['loops']:g}, {schedule_in_words(settings['default']['schedule'])}. "
            "Framed: the default.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_curves(axes: "Axes", result: Mapping, starts: str) -> None:
    edges = next(row["curve_edges"] for row in result["rows"] if "curve_edges" in row)
    middle = np.sqrt((np.array(edges[:-1]) + 1) * np.array(edges[1:]))
    for row in result["rows"]:
        if "curve_of" in row and row["starts"] == starts:
            way, label = _LINES[row["curve_of"]]
            mean, spread = np.array(row["mean"]), np.array(row["deviation"])
            low, high = np.clip(mean - spread, 0, None), np.clip(mean + spread, None, 1000)
            axes.fill_between(middle, low, high, color=ADVISORS[way], alpha=0.16, lw=0)
            axes.plot(middle, mean, color=ADVISORS[way], label=label)
    axes.axvline(10, color=INK, lw=0.9, ls=(0, (4, 3)))
    axes.annotate(
        "a handful", (10, 1), (3, -2), xycoords=("data", "axes fraction"), textcoords="offset points",
        va="top", fontsize=7.5, color=GREY,
    )  # fmt: skip
    axes.set(xscale="log", ylim=(0, 1040), xlabel="episode", xlim=(1, edges[-1]))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid(axis="y", color=LIGHT)
    axes.set_title(_STARTS[starts])


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    columns = list(product(settings["loops"], settings["experts"]))
    hows = list(product(settings["starts"], settings["schedules"]))
    values, sides = [], []
    for starts, schedule in hows:
        for name, (_, label) in _LINES.items():
            found = [_cell(result, loops, e, starts, schedule) for loops, e in columns]
            values.append([100 * row[name]["in_ten"] for row in found])
            sides.append(f"start {starts}, {_brief(schedule)}, {label}")
    heads = [f"{EXPERT_NAMES[experts]}\n{loops:g}" for loops, experts in columns]
    row = 2 * hows.index((default["starts"], default["schedule"])) + 1
    framed = (row, columns.index((default["loops"], default["experts"])))
    most = np.array(values) > 50
    draw_heat_grid(
        axes, values, most, sides, heads, neutral=0.0, spread=100.0, words="{:.0f}".format, outlined=framed
    )
    axes.set_title("Goals found within ten episodes (% of tasks; bold: most)")
    axes.set_xlabel("experts, and share of walls opened into loops")


def _cell(result: Mapping, loops: float, experts: str, starts: str, schedule: Sequence[float]) -> Mapping:
    wanted = {"loops": loops, "experts": experts, "starts": starts, "schedule": schedule}
    return next(row for row in result["rows"] if "plain" in row and all(row[key] == wanted[key] for key in wanted))


def _brief(schedule: Sequence[float]) -> str:
    first, decay, _ = schedule
    return f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}"
