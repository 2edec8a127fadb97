"""Curves with bands: a line for the mean of each series and a shaded interval around it."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from lifelore.figures.style import GREY, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_curves(
    axes: "Axes",
    x: ArrayLike | None,
    series: Mapping[str, Mapping[str, Any]],
    *,
    looks: Mapping[str, Mapping[str, Any]] | None = None,
    title: str = "",
    xlabel: str = "",
    ylabel: str = "",
    level: tuple[float, str] | None = None,
    legend: bool = True,
) -> None:
    """Draw series of a mean with a band each.

    Parameters
    ----------
    axes : matplotlib axes
    x : (n,) or None
        Places of the points; a series may have an ``x`` of its own instead.
    series : mapping
        Label → ``{"mean": (n,)}`` and, for a band, ``deviation`` (n,), half of its width.
    looks : mapping, optional
        Label → matplotlib's line properties (``color``, ``linewidth``, ``linestyle``, ``marker``, …).
    title, xlabel, ylabel : str
    level : (value, label), optional
        A dotted horizontal line, such as the optimum.
    legend : bool
    """
    for label, curve in series.items():
        mean = np.asarray(curve["mean"], float)
        places = np.asarray(curve.get("x", x if x is not None else np.arange(1, len(mean) + 1)), float)
        look = {"color": GREY, **(looks or {}).get(label, {})}
        if curve.get("deviation") is not None:
            half = np.asarray(curve["deviation"], float)
            axes.fill_between(places, mean - half, mean + half, color=look["color"], alpha=0.18, linewidth=0)
        axes.plot(places, mean, label=label, **look)
    if level is not None:
        axes.axhline(level[0], color=INK, linestyle=(0, (1, 2)), linewidth=1.2, label=level[1], zorder=1)
    axes.set(title=title, xlabel=xlabel, ylabel=ylabel)
    if legend and series:
        axes.legend()
