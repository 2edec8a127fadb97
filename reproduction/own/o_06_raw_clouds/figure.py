"""Share of objects found in clouds without labels, by method."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, SKY, Axes
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

NAMES = {"convexity": "local convexity", "clusters": "distance clusters", "colour": "colour clusters"}


@panels(6.2, 3.0, grid="x")
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result: a group of bars for simulated scenes, one for real ones."""
    groups = {f"{row['scenes']} scenes": [row[name] for name in NAMES] for row in result["rows"]}
    colours = dict(zip(groups, (BLUE, SKY), strict=False))
    draw_interval_bars(
        axes, list(NAMES.values()), groups, colours=colours, words="{:.2f}".format, legend=True,
        title="Objects found without labels", label="share with an IoU of at least 0.5",
    )  # fmt: skip
    axes.set_xlim(0, 1.12)
