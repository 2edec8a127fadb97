"""Validity of plans and share of objects with a plan, over the least probability of a fact."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREEN, GREY, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Series = Mapping[str, Sequence[float]]
"""``planned``, ``valid``, ``low`` and ``high`` (the interval of ``valid``), one value a threshold."""


def draw_plan_validity(
    thresholds: Sequence[float], default: float, panels: Mapping[str, tuple[Series, Series]]
) -> "Figure":
    """The figure: a panel for each kind of scene, two a row.

    Parameters
    ----------
    thresholds : (n,) least probabilities, increasing
    default : the default threshold
    panels : by title, the series with hidden tops unknown, and with hidden tops taken as clear
    """
    with house_style():
        rows = -(-len(panels) // 2)
        figure = new_figure(9.4, 3.6 * rows + 0.3)
        axes = figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False)
        lowest = min(min(series["planned"]) for both in panels.values() for series in both)
        for place, (title, (unknown, as_clear)) in zip(axes.flat, panels.items(), strict=False):
            _panel(place, thresholds, default, unknown, as_clear)
            place.set(title=title, ylim=(min(0.5, lowest - 0.05), 1.02))
        for place in axes.flat[len(panels) :]:
            place.set_axis_off()
        for place in axes[-1]:
            place.set_xlabel("least probability of a stated fact")
        for place in axes[:, 0]:
            place.set_ylabel("share")
        axes[0, 0].legend(loc="lower left", frameon=True, framealpha=1, edgecolor="none", fontsize=7.5)
        figure.suptitle("Plans that fetch an object, from perceived facts")
    return figure


def _panel(axes: "Axes", x: Sequence[float], default: float, unknown: Series, as_clear: Series) -> None:
    axes.axvline(default, color=GREY, linewidth=1, linestyle=(0, (2, 2)))
    axes.fill_between(x, unknown["low"], unknown["high"], color=GREEN, alpha=0.15, linewidth=0)
    for series, dashes, name in (
        (unknown, "solid", "hidden tops unknown"),
        (as_clear, (0, (4, 2)), "hidden tops taken as clear"),
    ):
        for key, colour, measure in (("valid", GREEN, "valid plans"), ("planned", BLUE, "objects with a plan")):
            axes.plot(x, series[key], color=colour, linestyle=dashes, linewidth=1.6, label=f"{measure}, {name}")
