"""Shares of the agents by kind of schedule, with 95 % intervals."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, Axes
from reproduction.chapter5.c5_09_switching.agents import AGENTS, KNOWS
from reproduction.chapter5.c5_09_switching.run import key_of
from reproduction.chapter5.c5_09_switching.schedules import GROUPS
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

LABELS = {
    "known": "static", "every_ten": "any type\nevery ten", "every_two": "any type\nevery two",
    "adaptive": "adaptive", "exact": "exact\npatterns", "noise": "patterns,\n20 % noise",
    "unknown": "unknown\npatterns",
}  # fmt: skip
COLOURS = (GREY, SKY, ORANGE, BLUE, PURPLE, GREEN)
"""Of the agents in their order."""


@panels(10.5, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """A group of bars for each kind of schedule, a bar for each agent; the line is who knows the type."""
    shares = {
        name: [result["measured"][f"{key_of(name)}_{group}"] for group in GROUPS]
        for name in AGENTS
        if name != KNOWS
    }
    names = [LABELS[group] for group in GROUPS]
    draw_interval_bars(axes, names, shares, colours=COLOURS, horizontal=False, words=None, legend=False)
    axes.axhline(1, color=INK, linestyle=":", linewidth=1)
    axes.set(ylabel="share of what is gained\nwith the type known", ylim=(0, 1.05))
    axes.set_axisbelow(True)
    axes.figure.legend(loc="outside right upper")
