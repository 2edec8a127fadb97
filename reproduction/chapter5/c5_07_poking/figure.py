"""Share of objects found before and after pushes, by kind of scene."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, Axes
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

KINDS = {
    "": "all", "_varied": "varied: groups,\npiles, books", "_flush": "flush: blocks\nwithout a crease",
    "_occluded": "occluded: a block\nseen in two parts",
}  # fmt: skip


@panels(6.2, 3.4, grid="x")
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result."""
    groups = {
        words: [result["measured"][f"found_{when}{kind}"] for kind in KINDS]
        for when, words in (("before", "local convexity"), ("after", "after pushes"))
    }
    colours = {"local convexity": GREY, "after pushes": BLUE}
    draw_interval_bars(
        axes, list(KINDS.values()), groups, colours=colours, words="{:.2f}".format,
        title="Objects found", label="share with an IoU of at least 0.5", legend=False,
    )  # fmt: skip
    axes.set_xlim(0, 1.12)
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside lower right", ncols=2)
