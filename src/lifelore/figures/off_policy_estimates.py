"""Picture of `reuse evaluate`: the estimated mean outcome of each target, beside that of the log."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_TARGETS = 30
"""Targets drawn: those of the largest estimates."""
COLOURS = {"ips": GREY, "self-normalised": ORANGE, "doubly-robust": BLUE}


def draw_off_policy_estimates(document: Mapping) -> "Figure":
    """The picture from what `agent.personalise.evaluate.evaluate` returns."""
    known = [one for one in document["targets"] if one["estimates"]["doubly-robust"]]
    known = sorted(known, key=lambda one: -one["estimates"]["doubly-robust"]["value"])[:MOST_TARGETS]
    with house_style():
        figure = new_figure(7.2, 1.6 + 0.42 * max(len(known), 2))
        axes = figure.subplots()
        logged = document["logged"]
        if logged["ci95"]:
            axes.axvspan(*logged["ci95"], color=LIGHT, alpha=0.6, linewidth=0, zorder=0)
        axes.axvline(logged["value"], color=INK, linewidth=1.0, linestyle=(0, (3, 2)), zorder=1, label="the log")
        for place, target in enumerate(known):
            for number, (name, estimate) in enumerate(target["estimates"].items()):
                if estimate is None:
                    continue
                at = place + 0.22 * (number - 1)
                colour = COLOURS[name]
                if estimate["ci95"]:
                    axes.plot(estimate["ci95"], [at, at], color=colour, linewidth=1.4, zorder=2)
                label = name if place == 0 else None
                axes.plot([estimate["value"]], [at], "o", color=colour, ms=4.5, zorder=3, label=label)
        axes.set_yticks(range(len(known)), [_short(one["name"]) for one in known], parse_math=False)
        axes.set_ylim(max(len(known), 1) - 0.4, -0.6)
        axes.grid(axis="x", color=LIGHT)
        axes.set(
            xlabel=f"mean outcome; {document['decisions']} decisions for {document['users']} users, "
            "bars: 95 % intervals"
        )
        figure.legend(loc="outside upper center", ncols=4)
    return figure


def _short(name: str) -> str:
    return name if len(name) <= 28 else name[:27] + "…"
