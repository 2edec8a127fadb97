"""The share of pictures that are perceived within so many seconds."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, ORANGE, Axes
from reproduction.chapter2.c2_04_time_per_image.run import KINDS
from reproduction.figures.panels import panels


@panels(5.6, 3.0, grid="both")
def draw(result: Mapping, axes: Axes) -> None:
    """A curve for each kind of picture; a line at a second."""
    for row, colour in zip(result["rows"], (BLUE, ORANGE), strict=False):
        points = result["measured"][f"points_{row['kind']}"]["value"]
        share = 100 * np.arange(1, len(row["seconds"]) + 1) / len(row["seconds"])
        label = f"{KINDS[row['kind']]} ({points:,.0f} points)"
        axes.step([0, *row["seconds"]], [0, *share], where="post", color=colour, label=label)
    axes.axvline(1, color=GREY, lw=1, ls=(0, (4, 3)))
    axes.annotate("a second", (1, 3), (-4, 0), textcoords="offset points", ha="right", fontsize=8, color=GREY)
    axes.set(
        xlabel="seconds of processor a picture", ylabel="share of pictures (%)", xlim=(0, None), ylim=(0, 101)
    )
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=2)
