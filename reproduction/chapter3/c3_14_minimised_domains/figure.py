"""Figure of claim C3.14: traps, collisions and episodes of learning in the domain and in the minimised domain."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, Figure, new_figure
from reproduction.figures.interval_bars import draw_interval_bars

PANELS = {
    "traps": (1, "Trap states and dead ends"),
    "collisions": (100, "Collisions in 100 steps\nof random exploring"),
    "to_80": (1, "Episodes to 80 %\nof optimal return"),
}
"""Factor and title by number."""
COLOURS = {"domain": GREY, "minimised": BLUE}


def draw(result: Mapping) -> Figure:
    """The figure from the result: kinds of worlds downwards."""
    figure = new_figure(9.2, 0.9 + 0.42 * len(result["rows"]))
    panels = figure.subplots(1, len(PANELS), sharey=True)
    for axes, (name, (factor, title)) in zip(panels, PANELS.items(), strict=True):
        groups = {way: [row[name][place] for row in result["rows"]] for place, way in enumerate(COLOURS)}
        names = [row["kind"] for row in result["rows"]]
        draw_interval_bars(axes, names, groups, colours=COLOURS, scale=factor, title=title, legend=False)
        axes.set_xlim(0, 1.2 * axes.get_xlim()[1])
        axes.grid(axis="x")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower left", ncols=2)
    return figure
