"""Share of walls that match, by kind of map: a dot an office; the dotted line is the least for a recognition."""

from collections.abc import Mapping

from lifelore.agent.live.buildings.recognition import LEAST_MATCH
from lifelore.figures.style import BLUE, GREY, VERMILION, Figure, new_figure


def draw(result: Mapping) -> Figure:
    """Blue: the same building; red: another one."""
    rows = result["rows"]
    figure = new_figure(7.2, 0.4 * len(rows) + 1.0)
    axes = figure.subplots()
    for place, row in enumerate(rows):
        colour = BLUE if row["same"] else VERMILION
        axes.plot(row["match"], [place] * len(row["match"]), "o", color=colour, alpha=0.5, ms=6, mew=0)
    axes.axvline(LEAST_MATCH, color=GREY, linestyle=(0, (1, 2)))
    axes.set(yticks=range(len(rows)), yticklabels=[row["map"] for row in rows], xlabel="share of walls that match")
    axes.set(xlim=(0, 1.02), ylim=(len(rows) - 0.5, -0.5))
    axes.grid(axis="x")
    return figure
