"""An action prior on its grid: an arrow where mass lies, the stronger the more mass it has."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, LIGHT, PAPER, WALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DIRECTIONS = np.array([(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (-1.0, 0.0)])
"""x and y of the moves north, south, east, west on axes whose y grows downwards."""
_INSIDE, _REACH = 0.05, 0.46  # where an arrow starts and how far the longest goes, in cells from the centre


def draw_prior(
    axes: "Axes",
    shape: tuple[int, int],
    cells: ArrayLike,
    probs: ArrayLike,
    counted: ArrayLike,
    *,
    negligible: float = 0.05,
    colour: str = BLUE,
    wall: str = WALL,
) -> None:
    """Draw a prior over four moves.

    Parameters
    ----------
    axes : matplotlib axes
        Row 0 is drawn at the top; a cell is one unit wide, its centre at (column, row).
    shape : (rows, columns)
    cells : (n, 2) int
        Row and column of each free cell; all others are drawn as wall.
    probs : (n, 4) float
        Probabilities of north, south, east, west; rows sum to 1.
    counted : (n,) bool
        Cells whose prior rests on counts; the others are shaded, without arrows.
    negligible : float
        No arrow for a probability up to this.
    colour, wall : str
        Of the arrows and of the walls.
    """
    cells, probs = np.asarray(cells), np.asarray(probs, float)
    counted = np.asarray(counted, bool)
    if cells.shape != (len(probs), 2) or probs.shape != (len(cells), 4) or counted.shape != (len(cells),):
        raise InputError(
            "cells, probs and counted must have shapes (n, 2), (n, 4) and (n,), "
            f"got {cells.shape}, {probs.shape} and {counted.shape}"
        )
    draw_cells(axes, shape, cells, counted, wall)
    cell, move = np.nonzero((probs > negligible) & counted[:, None])
    if cell.size:
        _draw_arrows(axes, cells[cell, ::-1], DIRECTIONS[move], probs[cell, move], colour)


def draw_cells(
    axes: "Axes", shape: tuple[int, int], cells: NDArray, counted: NDArray[np.bool_], wall: str = WALL
) -> None:
    """The grid itself: walls, free cells, and free cells nothing is known of."""
    from matplotlib.colors import to_rgb

    picture = np.empty((*shape, 3))
    picture[:] = to_rgb(wall)
    picture[tuple(cells.T)] = np.where(counted[:, None], to_rgb(PAPER), to_rgb(LIGHT))
    axes.imshow(picture, interpolation="nearest", zorder=0)
    if max(shape) <= 40:  # thin lines between cells help in a maze and would drown a building
        axes.set_xticks(np.arange(shape[1] + 1) - 0.5, minor=True)
        axes.set_yticks(np.arange(shape[0] + 1) - 0.5, minor=True)
        axes.grid(which="minor", color=LIGHT, linewidth=0.6)
    axes.tick_params(which="both", length=0, labelbottom=False, labelleft=False)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _draw_arrows(axes: "Axes", xy: NDArray, direction: NDArray, mass: NDArray, colour: str) -> None:
    """Arrows from near the centre of a cell; length and opacity grow with the square root of the mass."""
    from matplotlib.colors import to_rgb

    strength = np.sqrt(mass)[:, None]
    shade = np.column_stack([np.tile(to_rgb(colour), (len(mass), 1)), 0.3 + 0.7 * strength])
    start = xy + _INSIDE * direction
    length = (_REACH - _INSIDE) * (0.72 + 0.28 * strength) * direction
    axes.quiver(
        *start.T, *length.T, color=shade, angles="xy", scale_units="xy", scale=1, units="xy",
        width=0.062, headwidth=3.6, headlength=3.0, headaxislength=2.8, minlength=0, zorder=2,
    )  # fmt: skip
