"""Power of a trial on a robot by its number of tasks."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, INK, LIGHT, SKY, Figure, house_style, new_figure


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result: a curve for each size of the effect."""
    figure = new_figure(5.2, 3.2)
    axes = figure.subplots()
    for row, colour in zip(result["rows"], (SKY, BLUE, INK), strict=False):
        label = f"{row['effect']:g} standard deviations"
        axes.plot(result["settings"]["tasks"], row["power"], "o-", ms=3.5, color=colour, label=label)
    axes.set(xlabel="tasks, each with every agent", ylabel="power", ylim=(0, 1.02), title="Length of a trial")
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower right", title="true difference")
    return figure
