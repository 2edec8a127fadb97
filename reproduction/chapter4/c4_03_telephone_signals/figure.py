"""The calls' transition system, and regret by kind of signal (Figures 4.5 and 4.6)."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import Figure, new_figure
from reproduction.chapter4.c4_03_telephone_signals.call_graph import draw_call_graph
from reproduction.chapter4.reuse.looks import draw_linear, look_of

SHOWN = 100
"""Calls drawn: later ones are without regret."""


def draw(result: Mapping) -> Figure:
    """The system above; regret of each call, and summed up to it, where the signals differ most, below."""
    rows, settings = result["rows"], result["settings"]
    figure = new_figure(8.6, 6.2)
    top, bottom = figure.subfigures(2, 1, height_ratios=[1, 1.1])  # pyright: ignore
    draw_call_graph(top.subplots())
    left, right = bottom.subplots(1, 2)
    curves = {row["signal"]: row["regret"][:SHOWN] for row in rows}
    draw_linear(left, curves, 1, title="Regret of a call", xlabel="call")
    sums = {name: np.cumsum(values).tolist() for name, values in curves.items()}
    draw_linear(right, sums, 1, title="Regret summed up to the call", xlabel="call")
    for name, values in sums.items():
        shift = {"(s, a, s′)": -7, "(s, a, r)": 7}.get(name, 0)
        right.annotate(
            f"{name} {values[-1]:.1f}", (len(values), values[-1]), (4, shift), textcoords="offset points",
            va="center", fontsize=8, color=look_of(name)["color"],
        )  # fmt: skip
    for axes in (left, right):
        axes.lines[0].set_linewidth(4)  # the first two nearly coincide
    left.legend(title="signal")
    n = settings["groups"] * settings["users"]
    bottom.suptitle(f"{n:,} callers, {settings['models'][0]} language models, exact models", x=0.01, ha="left")
    return figure
