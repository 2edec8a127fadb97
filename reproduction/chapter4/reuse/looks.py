"""Colour and line of each rule, peer and signal in the figures of policy reuse."""

from collections.abc import Mapping
from typing import Any

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, YELLOW, Axes

PRINTED = (0, (2, 1.2))
"""Forms as printed, and tuned peers, are dashed in the colour of their standard form."""
_COLOURS = {
    "ε-greedy": YELLOW, "sampling": GREEN, "KG": VERMILION, "BE": ORANGE, "PI": PURPLE, "EI": BLUE,
    "UCB1": VERMILION, "GP-UCB": ORANGE, "interval estimation": INK,
    "(s, a, s′)": BLUE, "(s, a, r)": GREEN, "U": VERMILION,
    "BPR": BLUE, "PRQ": ORANGE, "Q-learning": GREY, "performance": SKY,
}  # fmt: skip


def look_of(name: str) -> dict[str, Any]:
    """Line properties of a rule, peer, signal or learner."""
    plain, _, form = name.partition(", ") if name not in _COLOURS else (name, "", "")
    return {"color": _COLOURS[plain], "ls": PRINTED if form else "-"}


def draw_linear(axes: Axes, curves: Mapping[str, list[float]], first: int, **properties: Any) -> None:
    """A line for each curve by episode from `first` on, on linear axes that start at 0."""
    for name, values in curves.items():
        axes.plot(range(first, first + len(values)), values, label=name, lw=1.5, **look_of(name))
    axes.set(ylim=(0, None), xlim=(0, None), **properties)
    axes.grid(axis="y")
