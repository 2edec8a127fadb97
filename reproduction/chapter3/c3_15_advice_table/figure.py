"""Figure of claim C3.15: the thesis's Table 3.1 as bars, the printed rewards beside ours."""

from collections.abc import Mapping

from lifelore.figures.style import INK, Axes
from reproduction.chapter3.advice.figures import ADVICE_COLOURS, AGENTS
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

WAYS = dict(zip(("alone", "advised", "apart"), ADVICE_COLOURS, strict=True))
PRINTED = {
    "random": (50, 900),
    "avoid": (50, 750),
    "left": (150, 750),
    "bug": (100, 800),
    "q_learning": (150, 1000),
    "optimal": (1000, 1000),
}
"""Table 3.1: reward without advice and with it."""


@panels(6.8, 4.6, grid="x")
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result: agents downwards."""
    rows = result["rows"]
    groups = {label: [row.get(way) for row in rows] for way, label in WAYS.items()}
    names = [AGENTS[row["agent"]] for row in rows]
    draw_interval_bars(
        axes, names, groups, colours=ADVICE_COLOURS, words=None, label="mean reward, of 1000", legend=False
    )
    height = 0.8 / len(groups)
    for place, row in enumerate(rows):
        for way, reward in enumerate(PRINTED[row["agent"]]):
            label = "thesis" if place == way == 0 else None
            axes.plot(
                reward, place + (way - 1) * height, "D", ms=5, mfc="none", color=INK, clip_on=False, label=label
            )
    axes.set_xlim(0, 1000)
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside lower left", ncols=4)
