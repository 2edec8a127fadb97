"""Golf by shot: mean distance to the hole beside single clubs, and entropy of the belief (Figure 4.4)."""

from collections.abc import Mapping

from lifelore.domains.golf.golf import CLUBS
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PURPLE, VERMILION, Axes
from reproduction.figures.panels import panels

CLUB_COLOURS = (BLUE, GREEN, ORANGE, PURPLE)


@panels(7.6, 3.9, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """Distance on the left axis with a level for each club, entropy on the right axis."""
    (row,), settings = result["rows"], result["settings"]
    shots = range(1, settings["shots"] + 1)
    axes.axhspan(10, 15, color=LIGHT, alpha=0.7, lw=0)
    axes.text(shots[-1], 15.4, "10–15 yards", ha="right", va="bottom", fontsize=8, color=GREY)
    for name, colour, missed in zip(CLUBS, CLUB_COLOURS, row["club"], strict=True):
        axes.axhline(missed, color=colour, lw=1, ls=(0, (1, 1.5)), label=f"only the {name}")
    axes.axhline(row["best"], color=INK, lw=1, ls=(0, (4, 2)), label="best club for each hole")
    axes.plot(shots, row["error"], "o-", color=BLUE, label="greedy policy reuse")
    axes.set(xlabel="shot", ylabel="mean distance to the hole (yards)", ylim=(0, None))
    right = axes.twinx()
    right.plot(shots, row["entropy"][:-1], "s-", color=VERMILION, ms=4, label="entropy (right axis)")
    right.set(ylim=(0, None), ylabel="entropy of the belief before the shot (nats)")
    right.spines["right"].set_visible(True)
    axes.figure.legend(loc="outside right upper")
    axes.set_title(f"{settings['groups']} × {settings['holes']} unknown holes, exact models")
