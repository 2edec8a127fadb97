"""Decorator of a claim's figure: the panels of a new figure, into which it draws."""

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any

from lifelore.figures.style import Figure, new_figure


def panels(
    width: float, height: float, *shape: int, grid: str = "y", **subplots: Any
) -> Callable[[Callable[..., None]], Callable[[Mapping], Figure]]:
    """Turn ``draw(result, axes, …)`` into a function of a result that returns the figure with these panels.

    Parameters
    ----------
    width, height : float
        Of the figure, inches.
    shape : int
        Rows and columns of panels; default: a single panel.
    grid : {"x", "y", "both", ""}
        Axis with grid lines; empty: none.
    subplots
        Arguments of matplotlib's ``subplots``, such as ``sharey=True``.
    """

    def decorated(draw: Callable[..., None]) -> Callable[[Mapping], Figure]:
        @wraps(draw)
        def drawn(result: Mapping) -> Figure:
            figure = new_figure(width, height)
            every = figure.subplots(*shape, squeeze=False, **subplots).ravel()
            draw(result, *every)
            for axes in every if grid else ():
                axes.grid(visible=True, axis=grid)
            return figure

        return drawn

    return decorated
