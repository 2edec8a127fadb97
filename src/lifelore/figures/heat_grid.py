"""A table of numbers as colours around a neutral value; what differs from it for certain is set in bold."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, INK, PAPER, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_heat_grid(
    axes: "Axes",
    values: ArrayLike,
    certain: ArrayLike,
    rows: Sequence[str],
    columns: Sequence[str],
    *,
    neutral: float,
    spread: float,
    words: Callable[[float], str] = "{:.1f}".format,
) -> None:
    """Draw the table.

    Parameters
    ----------
    axes : matplotlib axes
    values : (n_rows, n_columns)
        NaN is left white and unwritten.
    certain : (n_rows, n_columns) bool
        Whose 95 % interval excludes `neutral`.
    rows, columns : sequence of str
    neutral, spread : float
        The value drawn white, and the distance from it at which colour is full: blue above, vermilion below.
    words : callable
        A value's text; its minus signs are set as such.
    """
    from matplotlib.colors import LinearSegmentedColormap

    values, certain = np.asarray(values, float), np.asarray(certain, bool)
    if values.shape != (len(rows), len(columns)) or certain.shape != values.shape:
        shape = (len(rows), len(columns))
        raise InputError(f"values and certain must have shape {shape}, got {values.shape} and {certain.shape}")
    scaled = np.clip((values - neutral) / spread, -1, 1)
    colours = LinearSegmentedColormap.from_list("about", [VERMILION, PAPER, BLUE])
    axes.imshow(scaled, cmap=colours, vmin=-1, vmax=1, aspect="auto")
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            axes.text(
                column, row, words(value).replace("-", "−"), ha="center", va="center", fontsize=7.5,
                color=PAPER if abs(scaled[row, column]) > 0.75 else INK,
                fontweight="bold" if certain[row, column] else "normal",
            )  # fmt: skip
    _label(axes, rows, columns)


def _label(axes: "Axes", rows: Sequence[str], columns: Sequence[str]) -> None:
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.set_xticks(np.arange(len(columns) + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(rows) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color=PAPER, linewidth=1.5)
    axes.tick_params(which="both", length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
