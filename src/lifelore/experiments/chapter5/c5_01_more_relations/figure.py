"""How well words of space are learnt, and how often compound words mean what they say (claim C5.1)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.core.errors import InputError
from lifelore.experiments.chapter5.c5_01_more_relations.run import KINDS
from lifelore.experiments.chapter5.c5_01_more_relations.view_words import WORDS
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_word_scores(result["rows"], WORDS, str(result["settings"]["lessons"][-1]), KINDS)


_RIGHT, _WRONG, _MISSED = GREEN, VERMILION, GREY
_WAYS = {"thesis": "thesis", "lifelore": "by the points"}


def draw_word_scores(rows: Sequence[Mapping], words: Sequence[str], most: str, kinds: Sequence[str]) -> "Figure":
    """F1 by word on the left; on the right, by compound word and kind of scene, facts right, wrong and missed.

    Parameters
    ----------
    rows : sequence of mapping
        ``{"word", "lessons", "f1"}`` and ``{"compound", "scenes", "way", "right", "said", "true"}``.
    words : sequence of str
    most : str
        The largest number of lessons, as rows name it.
    kinds : sequence of str
        Of scenes, top to bottom.

    Raises
    ------
    InputError
        No row is of `most` lessons.
    """
    scores = {(row["word"], row["lessons"]): row["f1"] for row in rows if "word" in row}
    if not any(lessons == most for _, lessons in scores):
        raise InputError(f"rows must hold words after {most} lessons, got none")
    with house_style():
        figure = new_figure(11.2, 4.4)
        left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1, 1.45))[0]
        _words(left.subplots(), scores, words, most)
        grid = right.subplots(2, 2, sharex="row", sharey=True)
        for line, compound in zip(grid, ("between", "in"), strict=True):
            for axes, way in zip(line, _WAYS, strict=True):
                mine = {
                    row["scenes"]: row for row in rows if row.get("compound") == compound and row["way"] == way
                }
                _facts(axes, mine, kinds)
                axes.set_title(f"{compound}: {_WAYS[way]}")
        for axes in grid[1]:
            axes.set_xlabel("facts")
        handles, names = grid[0, 0].get_legend_handles_labels()
        right.legend(handles, names, loc="outside lower center", ncols=3)
    return figure


def _words(axes: "Axes", scores: Mapping, words: Sequence[str], most: str) -> None:
    marks = [(str(n), "o", 3.5, BLUE, 0.45) for n in sorted({int(key) for _, key in scores if key.isdigit()})[:-1]]
    marks += [(most, "o", 7, BLUE, 1.0), ("other side", "D", 4.5, ORANGE, 1.0), ("rule", "|", 11, INK, 1.0)]
    names = {"other side": "from the other side", "rule": "the rule, told, on visible points"}
    for who, marker, size, colour, opacity in marks:
        for place, word in enumerate(words):
            score = scores.get((word, who))
            if score is None or score["value"] is None:
                continue
            if score["ci95"] and who == most:
                axes.plot(score["ci95"], [place] * 2, color=colour, lw=1.4, zorder=2)
            label = names.get(who, f"learnt from {who} scenes") if place == 0 else None
            axes.plot(
                score["value"], place, marker, ms=size, color=colour, alpha=opacity, label=label, zorder=3, ls=""
            )
    axes.set_yticks(range(len(words)), [word.replace("_", " ") for word in words])
    axes.set_ylim(len(words) - 0.5, -0.5)
    axes.set_xlim(right=1.01)
    axes.set(xlabel="F1 on held-out shapes", title="learnt words")
    axes.grid(axis="x", color=LIGHT)
    axes.figure.legend(loc="outside lower center", ncols=2)


def _facts(axes: "Axes", rows: Mapping[str, Mapping], kinds: Sequence[str]) -> None:
    for place, kind in enumerate(kinds):
        row = rows.get(kind)
        if row is None:
            continue
        start = 0
        parts = (
            ("right", row["right"], _RIGHT),
            ("wrong", row["said"] - row["right"], _WRONG),
            ("missed", row["true"] - row["right"], _MISSED),
        )
        for name, length, colour in parts:
            axes.barh(place, length, left=start, height=0.7, color=colour, label=name if place == 0 else None)
            start += length
    axes.set_yticks(range(len(kinds)), kinds)
    axes.set_ylim(len(kinds) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color=LIGHT)
