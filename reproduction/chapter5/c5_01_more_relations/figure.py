"""F1 of learnt words of space, and how often compound words are right, wrong and missed (claim C5.1)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREEN, GREY, VERMILION, Axes
from reproduction.chapter5.c5_01_more_relations.run import COMPOUNDS, KINDS
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

PARTS = {"right": GREEN, "wrong": VERMILION, "missed": GREY}


@panels(11.2, 3.2, 1, 1 + len(COMPOUNDS), width_ratios=(1.1, 1, 1), grid="x")
def draw(result: Mapping, left: Axes, *of_compounds: Axes) -> None:
    """The figure from the result."""
    words = {row["word"].replace("_", " "): row["f1"] for row in result["rows"] if "word" in row}
    draw_interval_bars(
        left, list(words), {"": list(words.values())}, colours=[BLUE], words="{:.2f}".format,
        title="Learnt words", label="F1 on held-out shapes",
    )  # fmt: skip
    left.set_xlim(0, 1.15)
    for axes, compound in zip(of_compounds, COMPOUNDS, strict=True):
        own = {row["scenes"]: row for row in result["rows"] if row.get("compound") == compound}
        parts = {
            "right": [own[kind]["right"] for kind in KINDS],
            "wrong": [own[kind]["said"] - own[kind]["right"] for kind in KINDS],
            "missed": [own[kind]["true"] - own[kind]["right"] for kind in KINDS],
        }
        left_end = np.zeros(len(KINDS))
        for name, counts in parts.items():
            axes.barh(KINDS, counts, left=left_end, height=0.74, color=PARTS[name], label=name)
            left_end += counts
        axes.set(title=f"{compound}, by the thesis's rule", xlabel="facts", ylim=(len(KINDS) - 0.5, -0.5))
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)
    of_compounds[-1].legend(loc="upper right")
