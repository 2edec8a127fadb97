"""Figure of claim C3.18: P(M₁ | H) and rewards of explorers, told and not; what advice adds by each reading."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.explorer_palette import AGENTS, EXPERT_NAMES, NAMES
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_normalcy_curves(result)


_FIXED = ("random", "avoid", "left", "bug")
_STYLES = {"alone": "-", "told": (0, (1.2, 1.2))}
_READINGS = {"told": "all steps", "own": "own steps", "unadvised": "where untold"}


def draw_normalcy_curves(result: Mapping) -> "Figure":
    """The figure from the result of C3.18."""
    with house_style():
        figure = new_figure(10.4, 8.0)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[0.85, 1.15], hspace=0.02)[:, 0]
        left, right = upper.subplots(1, 2)
        _draw_curves(left, result, "normal", 1.0)
        _draw_curves(right, result, "reward", 1000.0)
        left.set(title="P(M₁ | H), advised steps counted, of those still walking", ylabel="P(M₁ | H)")
        right.set(title="Reward so far, of 1000")
        upper.legend(*_handles(), loc="outside upper left", ncols=6)
        _draw_grid(lower.subplots(), result)
        settings = result["settings"]
        lower.supxlabel(
            f"{settings['mazes']} mazes × {settings['tasks']} tasks; curves at loops "
            f"{settings['default']['loops']:g}, experts {settings['default']['experts']}. Bold: the interval over "
            "mazes excludes 0. Framed: the default.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _handles():
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=AGENTS[agent], lw=2.2) for agent in _FIXED]
    lines += [Line2D([], [], color=INK, lw=1.6, ls=style) for style in _STYLES.values()]
    return lines, [*(NAMES[agent] for agent in _FIXED), "no advice", "advised"]


def _draw_curves(axes: "Axes", result: Mapping, key: str, top: float) -> None:
    settings = result["settings"]
    length = settings["max_steps"] / settings["blocks"]
    ends = length * np.arange(1, settings["blocks"] + 1)
    for row in result["rows"]:
        if "curve_of" in row:
            values = [np.nan if value is None else value for value in row[key]]
            axes.plot(ends, values, color=AGENTS[row["curve_of"]], ls=_STYLES[row["way"]], lw=1.7)
    axes.set(xlabel="step", ylim=(-0.02 * top, 1.02 * top), xlim=(0, settings["max_steps"]))
    axes.grid(axis="y", color=LIGHT)


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    settings, default = result["settings"], result["settings"]["default"]
    columns = [(loops, experts) for loops in settings["loops"] for experts in settings["experts"]]
    heads = [f"{EXPERT_NAMES[experts]}\n{loops:g}" for loops, experts in columns]
    cells = {(r["loops"], r["experts"], r["agent"]): r for r in result["rows"] if "gain" in r}
    values, certain, sides = [], [], []
    for reading, words in _READINGS.items():
        for agent in _FIXED:
            found = [cells[(*column, agent)] for column in columns]
            gains = [row["gain"][reading] for row in found]
            values.append([np.nan if gain is None else gain for gain in gains])
            certain.append([row["certain"][reading] for row in found])
            sides.append(f"{words}: {NAMES[agent]}")
    draw_heat_grid(axes, values, certain, sides, heads, neutral=0.0, spread=0.8, words=_signed)
    framed = columns.index((default["loops"], default["experts"]))
    axes.axvspan(framed - 0.5, framed + 0.5, fill=False, ec=INK, lw=1.6, zorder=3)
    axes.set_title("What advice adds to an errand's mean P(M₁ | H): H of all steps, of own steps, at untold steps")
    axes.set_xlabel("experts, and share of walls opened into loops")


def _signed(value: float) -> str:
    return f"{value:+.2f}".replace("-", "−")
