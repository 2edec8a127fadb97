"""Performance as a surface over types and policies, known only along some types (the thesis's Figure 4.13).

Types are bands on the surface, policies the curves across it; the agent knows the dots where they cross. On the
left wall the bands of two types stand as curves over the policies, with their deviations.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, GREY, INK, VERMILION, house_style, new_figure

_FINE = 60


def draw_response_surface(
    mean: ArrayLike,
    deviation: ArrayLike,
    types: Sequence[str],
    policies: Sequence[str],
    shown: tuple[int, int] = (0, -1),
    *,
    words: tuple[str, str, str] = ("type", "policy", "performance"),
):
    """Draw the surface through the known means ``(n_types, n_policies)``, finite, at least two of each.

    `shown` are the numbers of the two types drawn as bands, `words` the labels of the axes.
    """
    mean, deviation = np.asarray(mean, float), np.asarray(deviation, float)
    if mean.ndim != 2 or min(mean.shape) < 2 or mean.shape != (len(types), len(policies)):
        raise InputError(f"mean must be ({len(types)}, {len(policies)}), at least two of each, got {mean.shape}")
    if deviation.shape != mean.shape or not (np.isfinite(mean) & np.isfinite(deviation)).all():
        raise InputError("deviation must be finite and of the shape of mean")
    rows = [int(np.arange(len(types))[i]) for i in shown]
    with house_style():
        figure = new_figure(6.6, 5.2)
        axes: Any = figure.add_subplot(projection="3d", computed_zorder=False)
        _draw_surface(axes, mean)
        for row, colour in zip(rows, (VERMILION, BLUE), strict=True):
            _draw_band(axes, row, mean, deviation, colour, types[row])
        axes.set_xticks(range(len(policies)), policies)
        axes.set_yticks(range(len(types)), types)
        axes.set_xlabel(words[1], labelpad=8)
        axes.set_ylabel(words[0], labelpad=14)
        axes.set_zlabel(words[2], labelpad=6)
        axes.set_ylim(len(types) - 0.5, -1.2)
        axes.view_init(24, -128)
        axes.legend(loc="upper left")
        axes.set_box_aspect((1.15, 1.15, 0.8), zoom=0.86)
    return figure


def _draw_surface(axes: Any, mean: NDArray[np.float64]) -> None:
    n_types, n_policies = mean.shape
    x, y = np.linspace(0, n_policies - 1, _FINE), np.linspace(0, n_types - 1, _FINE)
    across = np.array([_through(row, x) for row in mean])
    surface = np.array([_through(column, y) for column in across.T]).T
    axes.plot_surface(*np.meshgrid(x, y), surface, color="#d7dde4", alpha=0.55, linewidth=0, zorder=1)
    for policy in range(n_policies):
        axes.plot(np.full(_FINE, policy), y, _through(mean[:, policy], y), color=GREY, linewidth=0.9, zorder=2)


def _draw_band(
    axes: Any, row: int, mean: NDArray[np.float64], deviation: NDArray[np.float64], colour: str, name: str
) -> None:
    n_policies = mean.shape[1]
    x = np.linspace(0, n_policies - 1, _FINE)
    middle, half = _through(mean[row], x), np.maximum(_through(deviation[row], x), 0)
    width = 0.18
    strip = np.array([[row - width] * _FINE, [row + width] * _FINE])
    axes.plot_surface(np.array([x, x]), strip, np.array([middle, middle]), color=colour, alpha=0.35, zorder=3)
    axes.plot(x, np.full(_FINE, row), middle, color=colour, zorder=4, label=name)
    policies = np.arange(n_policies)
    axes.scatter(policies, np.full(n_policies, row), mean[row], color=INK, s=18, depthshade=False, zorder=6)
    wall = np.full(_FINE, -1.2)
    axes.plot(x, wall, middle, color=colour, linewidth=1.2, zorder=0.5)
    axes.plot_surface(
        np.array([x, x]), np.array([wall, wall]), np.array([middle - half, middle + half]), color=colour,
        alpha=0.18, zorder=0.4,
    )  # fmt: skip
    axes.scatter(policies, np.full(n_policies, -1.2), mean[row], color=INK, s=9, depthshade=False, zorder=0.6)


def _through(values: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """A smooth curve through values at 0, 1, 2, …, nowhere beyond its neighbours."""
    from scipy.interpolate import PchipInterpolator

    return PchipInterpolator(np.arange(len(values)), values)(at)
