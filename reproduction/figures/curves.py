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
        Label → ``{"mean": (n,)}`` and, for a band, ``low`` and ``high`` (n,), or ``deviation`` or ``error`` (n,),
        the half width of the band; without these there is no band.
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
        band = _band(curve, mean)
        if band is not None:
            axes.fill_between(places, band[0], band[1], color=look["color"], alpha=0.18, linewidth=0)
        axes.plot(places, mean, label=label, **look)
    if level is not None:
        axes.axhline(level[0], color=INK, linestyle=(0, (1, 2)), linewidth=1.2, label=level[1], zorder=1)
    axes.set(title=title, xlabel=xlabel, ylabel=ylabel)
    if legend and series:
        axes.legend()


def _band(curve: Mapping[str, Any], mean: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    if curve.get("low") is not None:
        return np.asarray(curve["low"], float), np.asarray(curve["high"], float)
    half = curve.get("deviation", curve.get("error"))
    if half is None:
        return None
    return mean - np.asarray(half, float), mean + np.asarray(half, float)
