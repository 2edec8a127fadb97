"""A table of numbers as colours around a neutral value; what differs from it for certain is set in bold."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

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
    good: str = "high",
    ratio: bool = False,
    words: Callable[[float], str] = "{:.1f}".format,
    outlined: tuple[int | None, int] | None = None,
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
        The value drawn white, and the distance from it at which colour is full.
    good : {"high", "low"}
        Which side of `neutral` is good: blue; the other is vermilion.
    ratio : bool
        Values are ratios: `spread` is a factor, so that half is as far from 1 as double.
    words : callable
        A value's text; its minus signs are set as such.
    outlined : (row, column), optional
        The cell to frame; a row of None frames the whole column.
    """
    from matplotlib.colors import LinearSegmentedColormap

    values, certain = np.asarray(values, float), np.asarray(certain, bool)
    if values.shape != (len(rows), len(columns)) or certain.shape != values.shape:
        shape = (len(rows), len(columns))
        raise InputError(f"values and certain must have shape {shape}, got {values.shape} and {certain.shape}")
    ends = [VERMILION, PAPER, BLUE] if good == "high" else [BLUE, PAPER, VERMILION]
    away = np.log(values / neutral) / np.log(spread) if ratio else (values - neutral) / spread
    scaled = np.clip(away, -1, 1)
    axes.imshow(scaled, cmap=LinearSegmentedColormap.from_list("about", ends), vmin=-1, vmax=1, aspect="auto")
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            axes.text(
                column, row, words(value).replace("-", "−"), ha="center", va="center", fontsize=7.5,
                color=PAPER if abs(scaled[row, column]) > 0.75 else INK,
                fontweight="bold" if certain[row, column] else "normal",
            )  # fmt: skip
    _label(axes, rows, columns)
    if outlined is not None:
        first, height = (0, len(rows)) if outlined[0] is None else (outlined[0], 1)
        frame_cells(axes, (first, outlined[1]), (height, 1))


def frame_cells(axes: "Axes", first: tuple[int, int], shape: tuple[int, int] = (1, 1)) -> None:
    """Frame the block of cells of a `shape` whose upper left cell is `first`, both as (rows, columns)."""
    from matplotlib.patches import Rectangle

    corner = first[1] - 0.5, first[0] - 0.5
    frame = Rectangle(corner, shape[1], shape[0], fill=False, edgecolor=INK, linewidth=1.6)
    frame.set(clip_on=False, zorder=3)
    axes.add_patch(frame)


def _excludes(number: Mapping[str, Any] | None, value: float) -> bool:
    interval = number["ci95"] if number else None
    return bool(interval) and not interval[0] <= value <= interval[1]


def _label(axes: "Axes", rows: Sequence[str], columns: Sequence[str]) -> None:
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.set_xticks(np.arange(len(columns) + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(rows) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color=PAPER, linewidth=1.5)
    axes.tick_params(which="both", length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
