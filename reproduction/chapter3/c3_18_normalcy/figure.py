"""Figure of claim C3.18: P(M₁ | H) and rewards of explorers, advised and not; what advice adds by each reading."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import name_groups
from lifelore.figures.style import GREY, INK, LIGHT, Axes, Figure, house_style, new_figure, two_rows
from reproduction.chapter3.advice.figures import (
    AGENT_COLOURS,
    EXPERTS_IN_WORDS,
    EXPLORERS,
    draw_maze_grid,
)
from reproduction.chapter3.advice.mazes import grid_of
from reproduction.engine.results_table import ResultsTable

STYLES = {"alone": "-", "told": (0, (1.2, 1.2))}
READINGS = {"told": "all steps", "own": "own steps", "unadvised": "unadvised steps"}


@house_style()
def draw(result: Mapping) -> Figure:
    """Curves by steps above, the grid of loop densities and experts below."""
    from matplotlib.lines import Line2D

    settings = result["settings"]
    figure = new_figure(10.4, 8.0)
    upper, lower = two_rows(figure, (0.85, 1.15))
    left, right = upper.subplots(1, 2)
    _draw_lines(left, result, "normal", 1.0)
    _draw_lines(right, result, "reward", 1000.0)
    left.set(title="P(M₁ | H), advised steps counted, of those still walking", ylabel="P(M₁ | H)")
    right.set_title("Reward so far, of 1000")
    lines = [Line2D([], [], color=AGENT_COLOURS[agent], lw=2.2) for agent in EXPLORERS]
    lines += [Line2D([], [], color=INK, lw=1.6, ls=style) for style in STYLES.values()]
    labels = [*EXPLORERS.values(), "no advice", "advised"]
    upper.legend(lines, labels, loc="outside upper left", ncols=6)
    _draw_grid(lower.subplots(), result)
    lower.supxlabel(
        f"{settings['mazes']} mazes × {settings['tasks']} tasks; curves at loops "
        f"{settings['default']['loops']:g}, experts {settings['default']['experts']}. Bold: the interval over "
        "mazes excludes 0. Framed: the default.\n"
        f"{EXPERTS_IN_WORDS}",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_lines(axes: Axes, result: Mapping, key: str, top: float) -> None:
    settings, series, looks = result["settings"], {}, {}
    ends = settings["max_steps"] / settings["blocks"] * np.arange(1, settings["blocks"] + 1)
    for row in (row for row in result["rows"] if "curve_of" in row):
        label = f"{row['curve_of']}, {row['way']}"
        series[label] = {"mean": np.array(row[key], float)}
        looks[label] = {"color": AGENT_COLOURS[row["curve_of"]], "ls": STYLES[row["way"]], "lw": 1.7}
    draw_curves(axes, ends, series, looks=looks, xlabel="step", legend=False)
    axes.set(ylim=(-0.02 * top, 1.02 * top), xlim=(0, settings["max_steps"]))
    axes.grid(axis="y", color=LIGHT)


def _draw_grid(axes: Axes, result: Mapping) -> None:
    cells = ResultsTable((row for row in result["rows"] if "gain" in row), ("loops", "experts", "agent"))
    values, certain, sides = [], [], []
    for reading in READINGS:
        for agent, name in EXPLORERS.items():
            found = [cells.record(loops=n, experts=e, agent=agent) for n, e in grid_of(result["settings"])]
            values.append([row["gain"][reading] for row in found])
            certain.append([row["certain"][reading] for row in found])
            sides.append(name)
    title = "What advice adds to an errand's mean P(M₁ | H): H of all steps, of own steps, at unadvised steps"
    look = {"neutral": 0.0, "spread": 0.8, "words": "{:+.2f}".format}
    draw_maze_grid(axes, result, np.array(values, float), certain, sides, title=title, **look)
    name_groups(axes, [(words.replace(" ", "\n", 1), len(EXPLORERS)) for words in READINGS.values()], 140)
