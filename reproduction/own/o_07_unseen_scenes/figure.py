"""Share of relations named exactly in scenes of unseen shapes, by method."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, SKY, Axes
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

LOOKS = {
    "exact_contacts": ("contacts with scene logic", BLUE),
    "exact_shipped": ("the shipped model", SKY),
    "exact_thesis": ("thesis's displacements", GREY),
    "exact_histogram": ("orientation histogram", GREY),
    "exact_rule": ("bounding-box rule", GREY),
}


@panels(6.4, 2.6, grid="x")
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result."""
    names, colours = zip(*LOOKS.values(), strict=True)
    draw_interval_bars(
        axes, names, {"": [result["measured"][name] for name in LOOKS]},
        colours=colours, words="{:.2f}".format,
        title="Relations of unseen shapes", label="share of pairs with the exact relation",
    )  # fmt: skip
    axes.set_xlim(0, 1.1)
