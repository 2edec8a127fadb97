"""F1 of learnt words of space, and how often compound words are right, wrong and missed (claim C5.1)."""

from collections.abc import Mapping

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.stacked_bars import draw_stacked_bars
from lifelore.figures.style import BLUE, GREEN, GREY, LIGHT, VERMILION, Figure, house_style, new_figure
from reproduction.chapter5.c5_01_more_relations.run import COMPOUNDS, KINDS

PARTS = {"right": GREEN, "wrong": VERMILION, "missed": GREY}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    figure = new_figure(11.2, 3.2)
    left, *panels = figure.subplots(1, 1 + len(COMPOUNDS), width_ratios=(1.1, 1, 1))
    words = {row["word"].replace("_", " "): row["f1"] for row in result["rows"] if "word" in row}
    draw_interval_bars(
        left, list(words), {"": list(words.values())}, colours=[BLUE], words="{:.2f}".format,
        title="Learnt words", label="F1 on held-out shapes",
    )  # fmt: skip
    left.set_xlim(0, 1.15)
    for axes, compound in zip(panels, COMPOUNDS, strict=True):
        own = {row["scenes"]: row for row in result["rows"] if row.get("compound") == compound}
        parts = {
            "right": [own[kind]["right"] for kind in KINDS],
            "wrong": [own[kind]["said"] - own[kind]["right"] for kind in KINDS],
            "missed": [own[kind]["true"] - own[kind]["right"] for kind in KINDS],
        }
        draw_stacked_bars(axes, KINDS, parts, PARTS, title=f"{compound}, by the thesis's rule", label="facts")
    for axes in (left, *panels):
        axes.grid(axis="x", color=LIGHT)
    panels[-1].legend(loc="upper right")
    return figure
