"""Share of objects found in clouds without labels, by method."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, LIGHT, SKY, Figure, house_style, new_figure
from reproduction.figures.interval_bars import draw_interval_bars

NAMES = {"convexity": "local convexity", "clusters": "distance clusters", "colour": "colour clusters"}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result: a group of bars for simulated scenes, one for real ones."""
    figure = new_figure(6.2, 3.0)
    axes = figure.subplots()
    groups = {f"{row['scenes']} scenes": [row[name] for name in NAMES] for row in result["rows"]}
    colours = dict(zip(groups, (BLUE, SKY), strict=False))
    draw_interval_bars(
        axes, list(NAMES.values()), groups, colours=colours, words="{:.2f}".format, legend=True,
        title="Objects found without labels", label="share with an IoU of at least 0.5",
    )  # fmt: skip
    axes.set_xlim(0, 1.12)
    axes.grid(axis="x", color=LIGHT)
    return figure
