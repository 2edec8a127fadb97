"""What agents miss of the best possible return over their lives, a panel for each world."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = {
    "full": BLUE,
    "no-prior": ORANGE,
    "no-reuse": GREEN,
    "scratch": GREY,
    "R-max, remembered model": PURPLE,
    "successor features, GPI": VERMILION,
    "infinite mixture, Gibbs sampling": INK,
    "probabilistic policy reuse": SKY,
    "Q-learning": SKY,
}
MOST = 5.0
"""Agents that miss this many times as much as scratch lie outside the panel and are named in its corner."""


def draw_world_lives(panels: Mapping[str, tuple[Sequence[float], Mapping[str, Sequence[float]]]]) -> "Figure":
    """The figure.

    Parameters
    ----------
    panels : mapping
        By world: numbers of tasks, and by agent the mean points missed in the first episodes around these tasks.
    """
    with house_style():
        columns = 2
        n_rows = -(-len(panels) // columns)
        figure = new_figure(9.4, 2.9 * n_rows)
        every = figure.subplots(n_rows, columns, squeeze=False).ravel()
        for axes in every[len(panels) :]:
            axes.set_axis_off()
        for axes, (world, (tasks, series)) in zip(every, panels.items(), strict=False):
            most, outside = MOST * max(series["scratch"]), []
            for name, missed in series.items():
                if max(missed) > most:
                    outside.append(name)
                else:
                    axes.plot(
                        tasks, missed, color=COLOURS[name], marker="o", markersize=3.5, linewidth=1.6, label=name
                    )
            axes.set(title=world, xlabel="task of the life", ylabel="points missed, first episode")
            axes.set_ylim(bottom=0)
            axes.xaxis.get_major_locator().set_params(integer=True)
            axes.legend(loc="lower left", frameon=False, fontsize=7)
            if outside:
                axes.text(
                    0.98, 0.97, "far above: " + ", ".join(outside), transform=axes.transAxes, ha="right", va="top",
                    fontsize=7, color=GREY,
                )  # fmt: skip
    return figure
