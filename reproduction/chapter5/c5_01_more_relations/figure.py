"""F1 of learnt words of space, and how often compound words are right, wrong and missed (claim C5.1)."""

from collections.abc import Mapping

from lifelore.figures.stacked_bars import draw_stacked_bars
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, VERMILION, house_style, new_figure
from reproduction.chapter5.c5_01_more_relations.measure import COMPOUNDS, OTHER_SIDE, RULE
from reproduction.chapter5.c5_01_more_relations.run import KINDS
from reproduction.chapter5.c5_01_more_relations.view_words import WORDS

PARTS = {"right": GREEN, "wrong": VERMILION, "missed": GREY}
WAYS = {"thesis": "thesis", "lifelore": "by the points"}


def draw(result: Mapping):
    facts = {(row["compound"], row["way"], row["scenes"]): row for row in result["rows"] if "compound" in row}
    with house_style():
        figure = new_figure(11.2, 4.4)
        left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1, 1.45))[0]
        draw_words(left, result)
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


def draw_words(figure, result: Mapping) -> None:
    """F1 of each word after all numbers of lessons, from the other side, and by the rule."""
    scores = {(row["word"], row["lessons"]): row["f1"] for row in result["rows"] if "word" in row}
    *fewer, most = map(str, result["settings"]["lessons"])
    small = zip(fewer, ("x", "s", "^", "v"), strict=False)
    marks = {n: (marker, 4.5, BLUE, 0.8, f"learnt from {n} scenes") for n, marker in small} | {
        most: ("o", 7, BLUE, 1.0, f"learnt from {most} scenes"),
        OTHER_SIDE: ("D", 4.5, ORANGE, 1.0, "from the other side"),
        RULE: ("|", 11, INK, 1.0, "the rule on visible points"),
    }
    axes = figure.subplots()
    for learner, (marker, size, colour, opacity, label) in marks.items():
        found = {place: scores[word, learner] for place, word in enumerate(WORDS)}
        found = {place: score for place, score in found.items() if score["value"] is not None}
        values = [score["value"] for score in found.values()]
        axes.plot(values, list(found), marker, ms=size, color=colour, alpha=opacity, label=label, zorder=3, ls="")
        for place, score in found.items() if learner == most else ():
            axes.plot(score["ci95"], [place] * 2, color=colour, lw=1.4, zorder=2)
    axes.set_yticks(range(len(WORDS)), [word.replace("_", " ") for word in WORDS])
    axes.set_ylim(len(WORDS) - 0.5, -0.5)
    axes.set_xlim(right=1.01)
    axes.set(xlabel="F1 on held-out shapes", title="learnt words")
    axes.grid(axis="x", color=LIGHT)
    figure.legend(loc="outside lower center", ncols=2)
