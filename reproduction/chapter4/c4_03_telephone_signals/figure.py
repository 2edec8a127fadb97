"""The calls' transition system, and regret by kind of signal (Figures 4.5 and 4.6)."""

from collections.abc import Mapping

import numpy as np

from lifelore.domains.telephone.telephone import HUNG_UP, OPEN, STATES, SUCCESS, reward
from lifelore.figures.style import BLUE, GREY, INK, PAPER, Axes, Figure, new_figure
from reproduction.chapter4.reuse.looks import draw_linear, look_of

SHOWN = 100
"""Calls drawn: later ones are without regret."""
PLACES = dict(zip(STATES, ((0, 0), (4, 0), (8, 0), (11, 0), (6, 2.5), (6, -2.5)), strict=True))
"""Where the states stand in the picture of the calls' transition system."""


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


def draw_call_graph(axes: Axes) -> None:
    """The states of a call, those that end it with thick rims; each edge with its probability and reward."""
    import networkx as nx

    graph = nx.DiGraph()
    for state in OPEN:
        for after, words in ((state + 1, "η"), (SUCCESS, "(1−η)ρ"), (HUNG_UP, "(1−η)(1−ρ)")):
            graph.add_edge(STATES[state], STATES[after], label=f"{words}\n[{reward(state, after):g}]")
    rims = [1.2 if STATES.index(name) in OPEN else 3.0 for name in graph]
    nx.draw_networkx(
        graph, PLACES, ax=axes, node_size=1600, node_color=PAPER, edgecolors=INK, linewidths=rims, font_size=6,
        edge_color=GREY, arrowsize=12,
    )  # fmt: skip
    nx.draw_networkx_edge_labels(
        graph, PLACES, nx.get_edge_attributes(graph, "label"), label_pos=0.58, ax=axes, rotate=False, font_size=7,
        font_color=BLUE, bbox={"fc": PAPER, "ec": "none", "pad": 0.5},
    )  # fmt: skip
    axes.margins(0.08, 0.2)
    axes.axis("off")
