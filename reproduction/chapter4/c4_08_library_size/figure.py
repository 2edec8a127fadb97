"""Mean regret by size of the library and number of episodes (Figure 4.12)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, SKY, Axes
from reproduction.figures.panels import panels


@panels(6.4, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """A line for each number of episodes over the size of the library."""
    from matplotlib.colors import LinearSegmentedColormap

    rows = result["rows"]
    shades = LinearSegmentedColormap.from_list("episodes", [SKY, BLUE, "#0b2a4a"])(np.linspace(0, 1, len(rows)))
    for row, shade in zip(rows, shades, strict=True):
        axes.plot([100 * s for s in row["shares"]], row["regret"], "o-", color=shade, ms=4, label=row["episodes"])
    axes.set(ylim=(0, None), xlabel="size of the library (% of 68 types)", ylabel="average episodic regret")
    axes.set_title(f"BPR-EI, {result['settings']['trials']} random tasks")
    axes.figure.legend(*axes.get_legend_handles_labels(), title="episodes", loc="outside right upper")
