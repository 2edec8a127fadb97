"""Learning curves: a line for the mean, a shaded interval, and bars for the episodes a method takes."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.figures.style import INK, colour_of, width_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_curve(
    axes: "Axes",
    x: ArrayLike,
    mean: ArrayLike,
    interval: tuple[ArrayLike, ArrayLike] | None,
    name: str,
    label: str | None = None,
) -> None:
    """One method's curve in its colour.

    Parameters
    ----------
    axes : matplotlib axes
    x, mean : (n,)
        Episodes (or tasks, steps) and the mean at each.
    interval : (low, high), each (n,), optional
        Ends of the shaded interval; the caption says which interval it is.
    name : str
        Method or agent, a key of `style.COLOURS`.
    label : str, optional
        Its name in the legend; default `name`.
    """
    if np.shape(x) != np.shape(mean):
        raise InputError(f"x and mean must agree in shape, got {np.shape(x)} and {np.shape(mean)}")
    colour = colour_of(name)
    if interval is not None:
        axes.fill_between(x, *interval, color=colour, alpha=0.18, linewidth=0)
    width = width_of(name)
    axes.plot(x, mean, color=colour, label=label or name, linewidth=width, zorder=10 - width)


def draw_optimal(axes: "Axes", value: float) -> None:
    """The dotted line of the average optimal return."""
    axes.axhline(value, color=INK, linestyle=(0, (1, 2)), linewidth=1.2, label="optimal", zorder=1)


def draw_episode_bars(
    axes: "Axes", names: Sequence[str], episodes: ArrayLike, intervals: Sequence, cap: float
) -> None:
    """Bars of episodes taken, one a method; a bar that ends at `cap` is marked ≥.

    Parameters
    ----------
    axes : matplotlib axes
    names : sequence of str
        Keys of `style.COLOURS`, top to bottom.
    episodes : (n,)
    intervals : sequence of (low, high) or None
    cap : float
        The number of episodes run; runs that never arrive count as this many.
    """
    values = np.asarray(episodes, float)
    places = -np.arange(len(values))
    axes.barh(places, values, height=0.72, color=[colour_of(name) for name in names], alpha=0.9)
    for place, value, interval in zip(places, values, intervals, strict=True):
        if interval:
            axes.plot(interval, [place, place], color=INK, linewidth=1.1, solid_capstyle="butt")
        text = f"≥ {value:.0f}" if value >= cap else f"{value:.0f}"
        axes.annotate(
            text, (max(value, interval[1] if interval else value), place), (4, 0),
            textcoords="offset points", va="center", fontsize=7.5,
        )  # fmt: skip
    axes.set(yticks=[], ylim=(places[-1] - 0.6, 0.6))
    axes.spines["left"].set_visible(False)
