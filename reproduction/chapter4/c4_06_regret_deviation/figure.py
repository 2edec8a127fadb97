"""Printed standard deviations beside those of many groups of ten tasks (Table 4.3)."""

from collections.abc import Mapping

from lifelore.figures.style import INK, Axes
from reproduction.chapter4.c4_06_regret_deviation.run import PRINTED
from reproduction.chapter4.reuse.looks import look_of
from reproduction.chapter4.surveillance.runs import AFTER
from reproduction.figures.panels import panels


@panels(9.2, 4.6, 2, 3, sharey=True)
def draw(result: Mapping, *every: Axes) -> None:
    """A panel a rule: median and middle 95 % of groups, PI also as printed (dashed); diamonds: the table."""
    settings = result["settings"]
    places = range(len(AFTER))
    for axes, (name, printed) in zip(every, PRINTED.items(), strict=True):
        for row in result["rows"]:
            if row["method"].partition(",")[0] == name:
                low, middle, high = row["quantiles"]
                look = look_of(row["method"])
                axes.fill_between(places, low, high, color=look["color"], alpha=0.18, lw=0)
                axes.plot(places, middle, **look)
        axes.plot(places, printed, "D", color="white", mec=INK, ms=6, mew=1.2)
        axes.set_xticks(places, [str(k) for k in AFTER])
        axes.set(title=name, ylim=(0, None))
    figure = every[0].figure
    figure.supxlabel("after episode (diamonds: the printed table; band: middle 95 % of groups)", fontsize=9)
    figure.supylabel("standard deviation of regret", fontsize=9)
    figure.suptitle(f"{settings['groups']} groups of {settings['tasks']} tasks, learnt models", x=0.01, ha="left")
