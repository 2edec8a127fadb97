"""Figure of C3.5, and of C3.6: reward of an episode against the number of prior tasks."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, INK, Axes
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

LOOKS = {
    "learnt": ("accumulated prior", {"color": BLUE}),
    "uniform": ("from scratch", {"color": GREY}),
    "optimal": ("optimal", {"color": INK, "linestyle": (0, (1, 2))}),
}


@panels(6.4, 4.2, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """The figure from the result of C3.5 or C3.6."""
    settings, rows = result["settings"], {row["curve_of"]: row for row in result["rows"]}
    series = {label: rows[name] for name, (label, _) in LOOKS.items()}
    series["optimal"] = {"mean": rows["optimal"]["mean"]}
    draw_curves(
        axes, np.arange(len(rows["optimal"]["mean"])), series, looks=dict(LOOKS.values()),
        xlabel="number of prior tasks", ylabel="average reward of an episode", legend=False,
    )  # fmt: skip
    axes.set_xlim(0, settings["prior_tasks"])
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    axes.legend(loc="center right")
    axes.figure.supxlabel(
        f"{settings['runs']} runs, {settings['episodes']} episodes a task; shaded: one standard deviation.",
        fontsize=8, color=GREY,
    )  # fmt: skip
