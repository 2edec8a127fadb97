"""Share of relations named exactly in scenes of unseen shapes, by method."""

from collections.abc import Mapping

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import BLUE, GREY, LIGHT, SKY, Figure, house_style, new_figure
from reproduction.own.o_07_unseen_scenes.run import METHODS

MEASURES = ("exact_contacts", "exact_shipped", "exact_thesis", "exact_histogram", "exact_rule")


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    figure = new_figure(6.4, 2.6)
    axes = figure.subplots()
    draw_interval_bars(
        axes, METHODS, {"": [result["measured"][name] for name in MEASURES]},
        colours=[BLUE, SKY, GREY, GREY, GREY], words="{:.2f}".format,
        title="Relations of unseen shapes", label="share of pairs with the exact relation",
    )  # fmt: skip
    axes.set_xlim(0, 1.1)
    axes.grid(axis="x", color=LIGHT)
    return figure
