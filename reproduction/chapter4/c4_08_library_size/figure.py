"""Mean regret by size of the library and number of episodes (Figure 4.12)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, LIGHT, SKY, Figure, house_style, new_figure


@house_style()
def draw(result: Mapping) -> Figure:
    """A line for each number of episodes over the size of the library."""
    from matplotlib.colors import LinearSegmentedColormap

    rows = result["rows"]
    shades = LinearSegmentedColormap.from_list("episodes", [SKY, BLUE, "#0b2a4a"])(np.linspace(0, 1, len(rows)))
    figure = new_figure(6.4, 3.8)
    axes = figure.subplots()
    for row, shade in zip(rows, shades, strict=True):
        axes.plot([100 * s for s in row["shares"]], row["regret"], "o-", color=shade, ms=4, label=row["episodes"])
    axes.set(ylim=(0, None), xlabel="size of the library (% of 68 types)", ylabel="average episodic regret")
    axes.set_title(f"BPR-EI, {result['settings']['trials']} random tasks")
    axes.grid(axis="y", color=LIGHT)
    figure.legend(*axes.get_legend_handles_labels(), title="episodes", loc="outside right upper")
    return figure
