"""Shares of the agents by kind of schedule, with 95 % intervals."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT,
    ORANGE,
    PURPLE,
    SKY,
    Figure,
    house_style,
    new_figure,
)
from reproduction.chapter5.c5_09_switching.agents import AGENTS, KNOWS
from reproduction.chapter5.c5_09_switching.run import key_of
from reproduction.chapter5.c5_09_switching.schedules import GROUPS

LABELS = {
    "known": "static", "every_ten": "any type\nevery ten", "every_two": "any type\nevery two",
    "adaptive": "adaptive", "exact": "exact\npatterns", "noise": "patterns,\n20 % noise",
    "unknown": "unknown\npatterns",
}  # fmt: skip
COLOURS = (GREY, SKY, ORANGE, BLUE, PURPLE, GREEN)
"""Of the agents in their order."""


@house_style()
def draw(result: Mapping) -> Figure:
    """A group of bars for each kind of schedule, a bar for each agent; the line is who knows the type."""
    figure = new_figure(10.5, 3.8)
    axes = figure.subplots()
    names = [name for name in AGENTS if name != KNOWS]
    width = 0.85 / len(names)
    for number, (name, colour) in enumerate(zip(names, COLOURS, strict=False)):
        measured = [result["measured"][f"{key_of(name)}_{group}"] for group in GROUPS]
        places = np.arange(len(GROUPS)) + (number - (len(names) - 1) / 2) * width
        axes.bar(places, [one["value"] for one in measured], width * 0.9, color=colour, label=name)
        for place, one in zip(places, measured, strict=True):
            if one["ci95"]:
                axes.plot([place, place], one["ci95"], color=INK, linewidth=1)
    axes.axhline(1, color=INK, linestyle=":", linewidth=1)
    axes.set(ylabel="share of what is gained\nwith the type known", ylim=(0, 1.05))
    axes.set_xticks(range(len(GROUPS)), [LABELS[group] for group in GROUPS])
    axes.grid(axis="y", color=LIGHT)
    axes.set_axisbelow(True)
    figure.legend(loc="outside right upper")
    return figure
