"""Learning curves of several methods under one schedule of ε: reward by episode, some with a band of deviation."""

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.prior_grid import schedule_in_words
from lifelore.figures.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DASHES = (0, (4, 2))


def draw_reward_curves(
    axes: "Axes",
    result: Mapping,
    schedule: Sequence[float],
    colours: Mapping[str, str],
    labels: Mapping[str, str],
    *,
    banded: Collection[str],
    dashed: Collection[str] = (),
) -> None:
    """One panel from the rows of a result that have ``curve_of``, ``schedule``, ``mean`` and ``deviation``.

    Parameters
    ----------
    axes : Axes
    result : mapping
        With ``episodes`` among its settings and ``optimal_reward`` among its measures.
    schedule : sequence of float
        The curves' own, and the panel's title.
    colours : mapping of str to str
        By method, in the order of drawing.
    labels : mapping of str to str
        Methods left out go by their name.
    banded, dashed : collection of str
        Methods whose deviation is shaded; methods whose line is dashed.
    """
    curves = {row["curve_of"]: row for row in result["rows"] if "curve_of" in row and row["schedule"] == schedule}
    episodes = np.arange(1, result["settings"]["episodes"] + 1)
    for method, colour in colours.items():
        mean, deviation = (np.array(curves[method][name]) for name in ("mean", "deviation"))
        if method in banded:
            axes.fill_between(episodes, mean - deviation, mean + deviation, color=colour, alpha=0.13, linewidth=0)
        style = DASHES if method in dashed else "-"
        axes.plot(episodes, mean, color=colour, label=labels.get(method, method), linewidth=1.5, linestyle=style)
    optimal = result["measured"]["optimal_reward"]["value"]
    axes.axhline(optimal, color=INK, linestyle=(0, (1, 2)), linewidth=1.2, label="optimal", zorder=1)
    axes.set(xscale="log", xlabel="episode", title=schedule_in_words(schedule), xlim=(1, len(episodes)))
    axes.xaxis.set_major_formatter("{x:g}")
