"""Share of relations named exactly in scenes of unseen shapes, by method."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, LIGHT, SKY, Figure, house_style, new_figure
from reproduction.figures.interval_bars import draw_interval_bars

LOOKS = {
    "exact_contacts": ("contacts with scene logic", BLUE),
    "exact_shipped": ("the shipped model", SKY),
    "exact_thesis": ("thesis's displacements", GREY),
    "exact_histogram": ("orientation histogram", GREY),
    "exact_rule": ("bounding-box rule", GREY),
}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    figure = new_figure(6.4, 2.6)
    axes = figure.subplots()
    names, colours = zip(*LOOKS.values(), strict=True)
    draw_interval_bars(
        axes, names, {"": [result["measured"][name] for name in LOOKS]},
        colours=colours, words="{:.2f}".format,
        title="Relations of unseen shapes", label="share of pairs with the exact relation",
    )  # fmt: skip
    axes.set_xlim(0, 1.1)
    axes.grid(axis="x", color=LIGHT)
    return figure
