"""A grid world as a floor plan: pale floor, inked walls, also those between two free cells."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.style import INK, PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SOLID = "#e6e9ed"
"""What is not floor."""
_SIDES = np.array(
    [
        [(-0.5, -0.5), (0.5, -0.5)],
        [(-0.5, 0.5), (0.5, 0.5)],
        [(0.5, -0.5), (0.5, 0.5)],
        [(-0.5, -0.5), (-0.5, 0.5)],
    ]
)
_NICE_LENGTHS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)


@dataclass(frozen=True, eq=False)
class FloorPlan:
    """The cells of a grid world as the ground of a picture; its metres are cells from the lower left corner.

    Parameters
    ----------
    shape, cells, neighbour
        See `draw_floor_plan`.
    """

    shape: tuple[int, int]
    cells: NDArray[np.integer]
    neighbour: NDArray[np.integer]

    @property
    def size(self) -> tuple[float, float]:
        """Height and width, cells."""
        height, width = np.ptp(self.cells, axis=0) + 3.0
        return float(height), float(width)

    @property
    def lane(self) -> float:
        """Cells between the ways of two tasks through one cell: beside each other in a large plan, too."""
        return float(np.clip(self.size[1] / 400.0, 0.15, 0.22))

    def placed(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points are drawn, (n, 2) column and row; whole numbers are the middles of cells."""
        x, y = np.asarray(points, float).reshape(-1, 2).T
        return np.column_stack([x - 0.5, self.shape[0] - 0.5 - y])

    def draw(self, axes: "Axes") -> None:
        """Draw the floor and its walls."""
        wall_width = float(np.clip(90.0 / self.size[1], 0.7, 1.8))
        draw_floor_plan(axes, self.shape, self.cells, self.neighbour, wall_width=wall_width)


def draw_floor_plan(
    axes: "Axes",
    shape: tuple[int, int],
    cells: ArrayLike,
    neighbour: ArrayLike,
    *,
    colours: ArrayLike | None = None,
    wall_width: float = 0.8,
) -> None:
    """Draw the floor and its walls, cut to where there is floor.

    Parameters
    ----------
    axes : matplotlib axes
        A cell is one unit wide, its centre at (column, row); row 0 is at the top.
    shape : (rows, columns)
    cells : (n, 2) int
        Row and column of each free cell.
    neighbour : (n, 4) int
        Where north, south, east, west lead from each; -1: a wall.
    colours : (n, 3) float, optional
        RGB of each cell, in [0, 1]; default paper white.
    wall_width : float
        Points.
    """
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    cells = np.asarray(cells)
    picture = np.empty((*shape, 3))
    picture[:] = to_rgb(SOLID)
    picture[tuple(cells.T)] = to_rgb(PAPER) if colours is None else colours
    axes.imshow(picture, interpolation="nearest", zorder=0)
    walls = LineCollection(
        list(wall_segments(cells, neighbour)), colors=INK, linewidths=wall_width, capstyle="projecting", zorder=3
    )
    axes.add_collection(walls, autolim=False)
    (top, left), (bottom, right) = cells.min(axis=0) - 1.5, cells.max(axis=0) + 1.5
    axes.set(xlim=(left, right), ylim=(bottom, top), xticks=[], yticks=[], aspect="equal")
    for spine in axes.spines.values():
        spine.set_visible(False)


def wall_segments(cells: ArrayLike, neighbour: ArrayLike) -> NDArray[np.float64]:
    """The walls as straight lines, as long as can be: (n, 2, 2), two ends of x and y in cells."""
    cell, side = np.nonzero(np.asarray(neighbour) < 0)
    centre = np.asarray(cells, float)[cell, ::-1]
    pieces = np.unique(centre[:, None, :] + _SIDES[side], axis=0)  # a wall between two cells is a side of both
    upright = pieces[:, 0, 0] == pieces[:, 1, 0]
    return np.concatenate([_joined(pieces[upright], along=1), _joined(pieces[~upright], along=0)])


def _joined(pieces: NDArray[np.float64], along: int) -> NDArray[np.float64]:
    """Pieces of length 1 that lie end to end on one line, as one."""
    pieces = pieces[np.lexsort((pieces[:, 0, along], pieces[:, 0, 1 - along]))]
    ends = (pieces[:-1, 1] != pieces[1:, 0]).any(axis=1)
    first, last = np.append(True, ends)[: len(pieces)], np.append(ends, True)[: len(pieces)]
    return np.stack([pieces[first, 0], pieces[last, 1]], axis=1)


def draw_scale_bar(axes: "Axes", cell: float) -> None:
    """A bar of a round number of metres below the plan's lower left corner; `cell` is a cell's side in metres."""
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    fitting = [length for length in _NICE_LENGTHS if length / cell <= (right - left) / 4]
    length = fitting[-1] if fitting else _NICE_LENGTHS[0]
    thickness = 0.008 * (right - left)
    y = bottom + 1.5 * thickness
    half = length / cell / 2
    for part, colour in ((0, INK), (1, PAPER)):
        axes.barh(
            y, half, left=left + 1.5 + part * half, height=thickness, color=colour, edgecolor=INK, linewidth=0.7,
            zorder=6,
        )  # fmt: skip
    axes.annotate(
        f"{length} m", (left + 1.5 + 2 * half, y), (5, 0), textcoords="offset points", va="center", fontsize=8
    )
    axes.set(xlim=(left, right), ylim=(bottom + 4 * thickness, top), facecolor=SOLID)


def tint(colours: Sequence[str], share: ArrayLike) -> NDArray[np.float64]:
    """(n, 3) RGB along a list of colours, `share` in [0, 1] from the first to the last."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("tint", list(colours))(np.asarray(share, float))[..., :3]
