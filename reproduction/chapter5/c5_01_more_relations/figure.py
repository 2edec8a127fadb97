"""F1 of learnt words of space, and how often compound words are right, wrong and missed (claim C5.1)."""

from collections.abc import Mapping

from lifelore.figures.stacked_bars import draw_stacked_bars
from lifelore.figures.style import BLUE, GREEN, GREY, LIGHT, VERMILION, Axes, Figure, house_style, new_figure
from reproduction.chapter5.c5_01_more_relations.run import COMPOUNDS, KINDS
from reproduction.chapter5.c5_01_more_relations.view_words import WORDS

PARTS = {"right": GREEN, "wrong": VERMILION, "missed": GREY}
MARKS = ("x", "s", "^", "v")


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    figure = new_figure(11.2, 3.4)
    left, *panels = figure.subplots(1, 1 + len(COMPOUNDS), width_ratios=(1.1, 1, 1))
    draw_words(left, [row for row in result["rows"] if "word" in row])
    for axes, compound in zip(panels, COMPOUNDS, strict=True):
        own = {row["scenes"]: row for row in result["rows"] if row.get("compound") == compound}
        parts = {
            "right": [own[kind]["right"] for kind in KINDS],
            "wrong": [own[kind]["said"] - own[kind]["right"] for kind in KINDS],
            "missed": [own[kind]["true"] - own[kind]["right"] for kind in KINDS],
        }
        draw_stacked_bars(axes, KINDS, parts, PARTS, title=f"{compound}, by the thesis's rule", label="facts")
        axes.grid(axis="x", color=LIGHT)
    panels[-1].legend(loc="lower right")
    return figure


def draw_words(axes: Axes, rows: list[Mapping]) -> None:
    """F1 of each word after all numbers of lessons."""
    *fewer, most = dict.fromkeys(row["lessons"] for row in rows)
    for lessons, marker in [*zip(fewer, MARKS, strict=False), (most, "o")]:
        own = {row["word"]: row["f1"] for row in rows if row["lessons"] == lessons}
        values = [own[word]["value"] for word in WORDS]
        size, opacity = (7, 1.0) if lessons == most else (4.5, 0.7)
        label = f"learnt from {lessons} scenes"
        axes.plot(values, range(len(WORDS)), marker, ms=size, color=BLUE, alpha=opacity, label=label, ls="")
        for place, word in enumerate(WORDS) if lessons == most else ():
            if own[word]["ci95"]:
                axes.plot(own[word]["ci95"], [place] * 2, color=BLUE, lw=1.4)
    axes.set_yticks(range(len(WORDS)), [word.replace("_", " ") for word in WORDS])
    axes.set(ylim=(len(WORDS) - 0.5, -0.5), xlabel="F1 on held-out shapes", title="Learnt words")
    axes.set_xlim(right=1.01)
    axes.grid(axis="x", color=LIGHT)
    axes.legend(loc="lower left", fontsize=7.5)
