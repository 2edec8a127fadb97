"""Power of a trial on a robot by its number of tasks."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, INK, SKY, Axes
from reproduction.figures.panels import panels


@panels(5.2, 3.2)
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result: a curve for each size of the effect."""
    for row, colour in zip(result["rows"], (SKY, BLUE, INK), strict=False):
        label = f"{row['effect']:g} standard deviations"
        axes.plot(result["settings"]["tasks"], row["power"], "o-", ms=3.5, color=colour, label=label)
    axes.set(xlabel="tasks, each with every agent", ylabel="power", ylim=(0, 1.02), title="Length of a trial")
    axes.legend(loc="lower right", title="true difference")
