"""F1 of learnt words of space, and how often compound words are right, wrong and missed (claim C5.1)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lifelore.experiments.chapter5.c5_01_more_relations.measure import COMPOUNDS, OTHER_SIDE, RULE
from lifelore.experiments.chapter5.c5_01_more_relations.run import KINDS
from lifelore.experiments.chapter5.c5_01_more_relations.view_words import WORDS
from lifelore.figures.stacked_bars import draw_stacked_bars
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PARTS = {"right": GREEN, "wrong": VERMILION, "missed": GREY}
WAYS = {"thesis": "thesis", "lifelore": "by the points"}


def draw(result: Mapping) -> "Figure":
    scores = {(row["word"], row["lessons"]): row["f1"] for row in result["rows"] if "word" in row}
    facts = {(row["compound"], row["way"], row["scenes"]): row for row in result["rows"] if "compound" in row}
    with house_style():
        figure = new_figure(11.2, 4.4)
        left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1, 1.45))[0]
        draw_words(left.subplots(), scores, [str(n) for n in result["settings"]["lessons"]])
        grid = right.subplots(2, 2, sharex="row", sharey=True)
        for line, compound in zip(grid, COMPOUNDS, strict=True):
            for axes, (way, shown) in zip(line, WAYS.items(), strict=True):
                own = [facts[compound, way, kind] for kind in KINDS]
                parts = {
                    "right": [row["right"] for row in own],
                    "wrong": [row["said"] - row["right"] for row in own],
                    "missed": [row["true"] - row["right"] for row in own],
                }
                draw_stacked_bars(axes, KINDS, parts, PARTS, title=f"{compound}: {shown}", label="facts")
                axes.grid(axis="x", color=LIGHT)
        right.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def draw_words(axes: "Axes", scores: Mapping[tuple[str, str], Mapping], lessons: list[str]) -> None:
    """F1 of each word after all numbers of lessons, from the other side, and by the rule."""
    marks = {n: ("o", 3.5, BLUE, 0.45, f"learnt from {n} scenes") for n in lessons[:-1]}
    marks |= {lessons[-1]: ("o", 7, BLUE, 1.0, f"learnt from {lessons[-1]} scenes")}
    marks |= {OTHER_SIDE: ("D", 4.5, ORANGE, 1.0, "from the other side")}
    marks |= {RULE: ("|", 11, INK, 1.0, "the rule on visible points")}
    for learner, (marker, size, colour, opacity, label) in marks.items():
        found = [(scores[word, learner], place) for place, word in enumerate(WORDS)]
        found = [(score, place) for score, place in found if score["value"] is not None]
        values, places = [score["value"] for score, _ in found], [place for _, place in found]
        axes.plot(values, places, marker, ms=size, color=colour, alpha=opacity, label=label, zorder=3, ls="")
        for score, place in found if learner == lessons[-1] else ():
            axes.plot(score["ci95"], [place] * 2, color=colour, lw=1.4, zorder=2)
    axes.set_yticks(range(len(WORDS)), [word.replace("_", " ") for word in WORDS])
    axes.set_ylim(len(WORDS) - 0.5, -0.5)
    axes.set_xlim(right=1.01)
    axes.set(xlabel="F1 on held-out shapes", title="learnt words")
    axes.grid(axis="x", color=LIGHT)
    axes.figure.legend(loc="outside lower center", ncols=2)
