"""Early regret over a life under five priors, in three worlds of tasks."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, INK, ORANGE, SKY, Axes
from reproduction.chapter5.c5_04_learnt_type_prior.run import (
    CONTEXT,
    CONTEXTS,
    DRIFT,
    LEARNT,
    LIBRARY,
    NO_DECAY,
    STEADY,
    TRUE,
)
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

TITLES = {
    STEADY: "Popularity alike in all contexts",
    CONTEXTS: "Popularity of each context its own",
    DRIFT: "The same, drawn again every {steady_for} tasks",
}
LOOKS = {
    LIBRARY: ("library's prior", {"color": GREY}),
    LEARNT: ("learnt, contexts ignored", {"color": SKY}),
    CONTEXT: ("learnt by context", {"color": BLUE, "linewidth": 2.2}),
    NO_DECAY: ("learnt by context, no decay", {"color": ORANGE}),
    TRUE: ("true popularity", {"color": INK, "linestyle": "--"}),
}
"""Label and line of each agent."""


@panels(12.4, 4.2, 1, 3, sharey=True)
def draw(result: Mapping, *every: Axes) -> None:
    """The figure from the result."""
    settings = result["settings"]
    for axes, (world, title) in zip(every, TITLES.items(), strict=True):
        own = [row for row in result["rows"] if row["world"] == world]
        series = {LOOKS[row["agent"]][0]: row for row in own}
        n = len(own[0]["mean"])
        tasks = (np.arange(n) + 0.5) * settings["tasks"] / n
        draw_curves(
            axes,
            tasks,
            series,
            looks=dict(LOOKS.values()),
            title=title.format(**settings),
            xlabel="tasks lived",
            legend=False,
        )
    every[0].set_ylim(0, None)
    every[0].set_ylabel(f"regret of a task's first {settings['early']} episodes")
    every[0].legend(loc="lower left")
    every[0].figure.suptitle(f"Means of {settings['lives']} lives with 95 % intervals", x=0.01, ha="left")
