"""Decisions of BEAT that are those of policy reuse, and why beliefs are stored as logarithms."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, INK, LIGHT, ORANGE, VERMILION, Figure, house_style, new_figure
from reproduction.chapter4.c4_16_beat_is_reuse.run import EPSILONS

SMALLEST = 745.0
"""Minus the log of the smallest positive float64."""


def draw(result: Mapping) -> Figure:
    rows = result["rows"]
    with house_style():
        figure = new_figure(10.0, 3.0)
        left, middle, right = figure.subplots(1, 3, width_ratios=[1.15, 1, 1])
        for place, name in enumerate(EPSILONS):
            mine = [row for row in rows if row["epsilon"] == name]
            alike, decisions = (sum(row[key] for row in mine) for key in ("alike", "decisions"))
            bar = left.barh(place, 100 * alike / decisions, color=BLUE, height=0.6)
            left.bar_label(bar, [f"{alike:,} of {decisions:,}"], label_type="center", color="white", fontsize=8)
        left.set_yticks(range(len(EPSILONS)), [f"ε = {name}" for name in EPSILONS])
        left.set(xlim=(0, 100), xlabel="decisions alike (%)", title="BEAT and policy reuse")
        left.invert_yaxis()
        spread = np.array([x for row in rows for x in row["spread"]])
        middle.hist(spread, bins=24, color=ORANGE)
        middle.axvline(SMALLEST, color=INK, linestyle=(0, (4, 2)), linewidth=1.2)
        middle.annotate(
            "smallest\npositive\nfloat64", (SMALLEST, 1), (4, -2), xycoords=("data", "axes fraction"),
            textcoords="offset points", va="top", fontsize=7.5, color=INK,
        )  # fmt: skip
        middle.set(
            xlabel="log belief, best less worst (nats)", ylabel="sessions", title="log beliefs after five episodes"
        )
        gone = np.array([x for row in rows for x in row["vanished"] if x])
        if gone.size:
            right.hist(gone, bins=24, color=VERMILION)
        right.set(xlabel="step at which every type has 0", ylabel="sessions", title="beliefs never normalised")
        for axes in (middle, right):
            axes.grid(axis="y", color=LIGHT)
    return figure
