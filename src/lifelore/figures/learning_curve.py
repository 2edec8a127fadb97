"""A method's learning curve in its colour: a line for the mean and a shaded interval."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.figures.style import colour_of, width_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_curve(
    axes: "Axes",
    x: ArrayLike,
    mean: ArrayLike,
    interval: tuple[ArrayLike, ArrayLike] | None,
    name: str,
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
    """
    if np.shape(x) != np.shape(mean):
        raise InputError(f"x and mean must agree in shape, got {np.shape(x)} and {np.shape(mean)}")
    colour = colour_of(name)
    if interval is not None:
        axes.fill_between(x, *interval, color=colour, alpha=0.18, linewidth=0)
    width = width_of(name)
    axes.plot(x, mean, color=colour, label=name, linewidth=width, zorder=10 - width)
