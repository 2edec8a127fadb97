"""Scatter plots: points of several groups, faded where they are many, with the axes through zero."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from lifelore.figures.scenes.object_palette import mixed
from lifelore.figures.style import GREY, INK, LIGHT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_scatter(
    axes: "Axes",
    groups: Mapping[str, ArrayLike],
    *,
    colours: Mapping[str, str] | None = None,
    markers: Mapping[str, str] | None = None,
    size: float = 18,
    legend: Mapping[str, Any] | None = None,
    title: str = "",
    xlabel: str = "",
    ylabel: str = "",
) -> None:
    """Draw the points of each group; many points fade, so that dense places stay visible.

    Parameters
    ----------
    axes : matplotlib axes
    groups : mapping
        Label → (n, 2) places, drawn in the order given.
    colours : mapping, optional
        Label → colour.
    markers : mapping, optional
        Label → matplotlib's marker of the group.
    size : float
        Of a marker, points squared.
    legend : mapping, optional
        Arguments of the legend; None draws no legend.
    title, xlabel, ylabel : str
    """
    axes.axhline(0, color=LIGHT, lw=1, zorder=0)
    axes.axvline(0, color=LIGHT, lw=1, zorder=0)
    for label, places in groups.items():
        at = np.asarray(places, float).reshape(-1, 2)
        colour, marker = (colours or {}).get(label, GREY), (markers or {}).get(label, "o")
        alpha = float(np.clip(12 / np.sqrt(max(1, len(at))), 0.25, 0.85))
        edge = {} if marker == "x" else {"edgecolors": mixed(colour, INK, 0.3)}
        axes.scatter(*at.T, s=size, marker=marker, color=colour, alpha=alpha, linewidths=0.5, **edge)
        axes.scatter([], [], s=22, marker=marker, color=colour, label=label)
    axes.set(title=title, xlabel=xlabel, ylabel=ylabel)
    if legend is not None:
        axes.legend(**{"handletextpad": 0.2, **legend})
