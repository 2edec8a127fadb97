"""Refused moves of a task by round, for fleets of one to eight robots."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, GREY, ORANGE, VERMILION, Axes
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

COLOURS = (GREY, GREEN, ORANGE, BLUE)


@panels(5.8, 3.5)
def draw(result: Mapping, axes: Axes) -> None:
    """A curve a fleet; the dotted line is the most of a competent fleet, the red one robots that know nothing."""
    *fleets, last = result["rows"]
    labels = [f"{row['robots']} robot{'s' if row['robots'] > 1 else ''}" for row in fleets]
    looks = {label: {"color": colour} for label, colour in zip(labels, COLOURS, strict=False)}
    series = {label: {"mean": row["fleet"]} for label, row in zip(labels, fleets, strict=True)}
    axes.axhline(last["nothing"], color=VERMILION, linewidth=1, label="knows nothing")
    share = result["settings"]["competent"][0]
    draw_curves(axes, None, series, looks=looks, level=(share * last["nothing"], f"competent: {share:.0%} of it"))
    axes.set(xlabel="round (a task of each robot)", ylabel="refused moves of a task", ylim=(0, None))
