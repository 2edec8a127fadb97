"""The transition system of a call as a picture (Figure 4.5)."""

import numpy as np

from lifelore.figures.style import BLUE, GREY, INK, PAPER, Axes

PLACES = {
    "start": (0.0, 0.0),
    "frustrated": (3.8, 0.0),
    "annoyed": (7.6, 0.0),
    "angry": (10.4, 0.0),
    "success": (5.7, 2.5),
    "hung up": (5.7, -2.5),
}
_ENDS = ("angry", "success", "hung up")
_RADIUS = 0.62
_SHARE = {"start": 0.42, "frustrated": 0.36, "annoyed": 0.66}
"""Where along an edge to success or hung up its label stands, by the state it leaves."""
_PATH = ("start", "frustrated", "annoyed")
EDGES = {
    (state, after): (words, reward)
    for k, state in enumerate(_PATH)
    for after, words, reward in (
        ((*_PATH, "angry")[k + 1], "η", 1.0),
        ("success", "(1−η)ρ", 10.0 - k),
        ("hung up", "(1−η)(1−ρ)", 3.0 - k),
    )
}
"""Probability and reward of each edge in reading A of the figure."""


def draw_call_graph(axes: Axes) -> None:
    """Draw states as circles, those that end the call with a thick rim."""
    from matplotlib.patches import Circle

    for (start, end), (probability, reward) in EDGES.items():
        _draw_edge(axes, start, end, probability, f"[{reward:g}]")
    for name, place in PLACES.items():
        axes.add_patch(Circle(place, _RADIUS, fc=PAPER, ec=INK, lw=3 if name in _ENDS else 1.2, zorder=3))
        axes.text(*place, name, ha="center", va="center", fontsize=6, zorder=4)
    axes.set(xlim=(-0.9, 11.3), ylim=(-3.25, 3.25), aspect="equal")
    axes.axis("off")


def _draw_edge(axes: Axes, start: str, end: str, probability: str, reward: str) -> None:
    place, way = np.array(PLACES[start]), np.subtract(PLACES[end], PLACES[start])
    step = way / np.hypot(*way)
    tail, head = place + _RADIUS * step, place + way - (_RADIUS + 0.04) * step
    arrow = {"arrowstyle": "-|>", "color": GREY, "lw": 1.1, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, arrowprops=arrow, zorder=2)
    level = way[1] == 0
    # Nearer the start, where edges to the same state have not yet met; each at a height of its own.
    x, y = tail + (0.5 if level else _SHARE[start]) * (head - tail)
    label = f"{probability}\n{reward}" if level else f"{probability} {reward}"
    axes.text(
        x, y, label, color=BLUE, ha="center", va="center", fontsize=7, zorder=2.5, linespacing=1.6,
        bbox={"boxstyle": "round,pad=0.12", "fc": "none" if level else PAPER, "ec": "none"},
    )  # fmt: skip
