"""Relative regret of six selection rules over all worlds, and their largest excess of stuck tasks."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, ORANGE, Axes
from reproduction.figures.panels import panels
from reproduction.own.o_01_default_rule.run import MOST_STUCK, RULES, key_of

PANELS = {"regret": BLUE, "stuck_above_least": ORANGE}


@panels(8.4, 2.8, 1, 2, sharey=True, grid="x")
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """A dot with its interval a rule; the dotted line is the most that a default may leave stuck."""
    for axes, (key, colour) in zip((left, right), PANELS.items(), strict=True):
        for place, rule in enumerate(RULES):
            number = result["measured"][f"{key}_{key_of(rule)}"]
            low, high = number["ci95"] or [number["value"]] * 2
            axes.plot([low, high], [place, place], color=colour, linewidth=2)
            axes.plot(number["value"], place, "o", color=colour, markersize=6)
    left.set(yticks=range(len(RULES)), yticklabels=list(RULES), xlabel="regret / regret of each world's best rule")
    left.invert_yaxis()
    right.axvline(MOST_STUCK, color=GREY, linestyle=(0, (1, 2)))
    right.set_xlabel("stuck tasks above the least stuck rule, worst world")
