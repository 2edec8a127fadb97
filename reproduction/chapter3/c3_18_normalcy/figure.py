"""Figure of claim C3.18: the thesis's Figure 3.21, P(M₁ | H) and rewards of explorers, advised and not."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import INK, Axes
from reproduction.chapter3.advice.figures import AGENT_COLOURS, EXPLORERS
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

STYLES = {"alone": "-", "advised": (0, (1.2, 1.2))}
PANELS = {"normal": ("P(M₁ | H) of walks under way", 1.0), "reward": ("mean reward so far, of 1000", 1000.0)}


@panels(9.0, 3.8, 1, 2)
def draw(result: Mapping, *every: Axes) -> None:
    """The figure from the result: the tasks of one maze; solid alone, dotted advised."""
    from matplotlib.lines import Line2D

    for axes, (key, (label, top)) in zip(every, PANELS.items(), strict=True):
        series, looks = {}, {}
        for row in result["rows"]:
            name = f"{row['curve_of']}, {row['way']}"
            series[name] = {"x": row["x"], "mean": np.array(row[key], float)}
            looks[name] = {"color": AGENT_COLOURS[row["curve_of"]], "ls": STYLES[row["way"]], "lw": 1.6}
        draw_curves(axes, None, series, looks=looks, xlabel="step", ylabel=label, legend=False)
        axes.set(ylim=(-0.02 * top, 1.02 * top), xlim=(0, result["settings"]["max_steps"]))
    lines = [Line2D([], [], color=AGENT_COLOURS[agent], lw=2.2) for agent in EXPLORERS]
    lines += [Line2D([], [], color=INK, lw=1.6, ls=style) for style in STYLES.values()]
    labels = [*EXPLORERS.values(), "without advice", "with advice"]
    every[0].figure.legend(lines, labels, loc="outside lower left", ncols=6)
