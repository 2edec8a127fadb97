"""Steps until a recurring goal is found, by method and law of the destinations."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_destinations(methods: Sequence[str], laws: Sequence[str], rows: Sequence[dict]) -> "Figure":
    """The figure: a bar for each method and law with its 95 % interval, on a logarithmic scale.

    Parameters
    ----------
    methods, laws : names, of which each pair has a row
    rows : of the benchmark, with ``name``, ``value`` and ``ci95``
    """
    found = {row["name"]: row for row in rows}
    with house_style():
        figure = new_figure(8.6, 3.4)
        axes = figure.subplots()
        for number, (law, colour) in enumerate(zip(laws, (BLUE, ORANGE), strict=True)):
            for place, method in enumerate(methods):
                row = found[f"{method}, {law}"]
                low, high = row["ci95"]
                y = place + 0.38 * number
                axes.barh(y, row["value"], 0.34, color=colour, label=law if not place else None)
                axes.plot([low, high], [y, y], color="black", linewidth=1)
                axes.annotate(f"{row['value']:.0f}", (high, y), (5, 0), textcoords="offset points", va="center")
        axes.set(xscale="log", xlim=(50, 2500), xlabel="steps until the goal is found")
        axes.set_yticks([place + 0.19 for place in range(len(methods))], methods)
        axes.invert_yaxis()
        axes.legend(title="goals", loc="lower right", frameon=False)
    return figure
