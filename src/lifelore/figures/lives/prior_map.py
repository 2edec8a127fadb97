"""An action prior over a whole world: how much it leaves open everywhere, and its arrows at close range."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.metrics import entropy
from lifelore.figures.lives.floor_plan import draw_floor_plan, draw_scale_bar, tint, wall_segments
from lifelore.figures.lives.prior_arrows import draw_prior
from lifelore.figures.style import BLUE, INK, SKY, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CLOSE_UP = 26
"""Cells a side of the close-up; worlds up to one and a half times that are drawn with arrows throughout."""
_SHADES = ("#0b3c5d", BLUE, SKY, "#fbf7ea")
_UNSEEN = "#c9b8c4"
_SOLID = "#c5cbd2"


def draw_prior_map(
    shape: tuple[int, int],
    cells: ArrayLike,
    neighbour: ArrayLike,
    probs: ArrayLike,
    counted: ArrayLike,
    *,
    cell: float | None = None,
    title: str = "",
) -> "Figure":
    """The prior over a world: the whole, coloured by how many moves it leaves open, and a close-up with arrows.

    Parameters
    ----------
    shape, cells, neighbour
        See `draw_floor_plan`.
    probs : (n, 4) float
        Probabilities of north, south, east, west; rows sum to 1.
    counted : (n,) bool
        Cells whose prior rests on counts.
    cell : float, optional
        Side of a cell in metres; with it a scale bar is drawn.
    title : str
    """
    cells, neighbour, counted = np.asarray(cells), np.asarray(neighbour), np.asarray(counted, bool)
    probs = np.asarray(probs, float)
    height, width = np.ptp(cells, axis=0) + 3
    large = max(height, width) > 1.5 * CLOSE_UP
    with house_style():
        if large:
            return _whole_and_close_up(shape, cells, neighbour, probs, counted, cell, title)
        figure = new_figure(7.0, 7.0 * height / width + 0.6)
        axes = figure.subplots()
        _draw_arrows(axes, cells, neighbour, probs, counted, cells.min(axis=0) - 1, cells.max(axis=0) + 2)
        axes.set_title(title)
    return figure


def _whole_and_close_up(shape, cells, neighbour, probs, counted, cell, title) -> "Figure":
    height, width = np.ptp(cells, axis=0) + 3
    figure, whole, close, scale = _panels(float(np.clip(width / height, 0.5, 2.5)))
    _draw_whole(whole, shape, cells, neighbour, probs, counted)
    if cell:
        draw_scale_bar(whole, cell)
    corner = close_up_corner(shape, cells, open_moves(probs), counted)
    inside = ((cells >= corner) & (cells < corner + CLOSE_UP)).all(axis=1)
    _draw_arrows(
        close, cells[inside], neighbour[inside], probs[inside], counted[inside], corner, corner + CLOSE_UP
    )
    _frame_close_up(whole, close, corner)
    _draw_scale(scale, counted)
    whole.set_title(title)
    close.set_title("Close up: an arrow where the prior puts mass")
    return figure


def _panels(aspect: float) -> tuple["Figure", "Axes", "Axes", "Axes"]:
    """Figure and axes of the whole, the close-up of the same height, and the scale of colours below."""
    # Placed by hand: the layout engine does not know that two squares of unlike maps are to be of one height.
    width, gap, above, below = 12.6, 0.15, 0.38, 0.72
    tall = (width - 3 * gap) / (aspect + 1)
    height = above + tall + below
    figure = new_figure(width, height)
    figure.set_layout_engine("none")

    def place(left: float, bottom: float, wide: float, high: float) -> "Axes":
        return figure.add_axes((left / width, bottom / height, wide / width, high / height))

    whole, close = place(gap, below, aspect * tall, tall), place(2 * gap + aspect * tall, below, tall, tall)
    return figure, whole, close, place(gap + 0.02, 0.28, 4.2, 0.13)


def open_moves(probs: ArrayLike) -> NDArray[np.float64]:
    """How many moves a prior leaves open, the exponential of its entropy: (n,) in [1, n_actions]."""
    probs = np.asarray(probs, float)
    return np.exp(entropy(probs))


def close_up_corner(
    shape: tuple[int, int],
    cells: NDArray,
    moves: NDArray[np.float64],
    counted: NDArray[np.bool_],
    size: int = CLOSE_UP,
) -> NDArray[np.int64]:
    """Row and column of the first window of `size` cells a side in which the prior has most to say."""
    counts = np.zeros((max(shape[0], size) + 1, max(shape[1], size) + 1))
    counts[tuple(cells.T + 1)] = np.where(counted, 4.0 - moves, 0.0)
    total = counts.cumsum(axis=0).cumsum(axis=1)
    windows = total[size:, size:] - total[:-size, size:] - total[size:, :-size] + total[:-size, :-size]
    return np.array(np.unravel_index(windows.argmax(), windows.shape))


def _draw_whole(axes: "Axes", shape, cells, neighbour, probs, counted) -> None:
    from matplotlib.colors import to_rgb

    shades = tint(_SHADES, (open_moves(probs) - 1) / 3)
    draw_floor_plan(axes, shape, cells, neighbour, colours=np.where(counted[:, None], shades, to_rgb(_UNSEEN)))
    axes.set_anchor("NW")


def _draw_scale(axes: "Axes", counted: NDArray[np.bool_]) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    scale = ScalarMappable(Normalize(1, 4), LinearSegmentedColormap.from_list("open", list(_SHADES)))
    bar = axes.figure.colorbar(scale, cax=axes, orientation="horizontal", ticks=[1, 2, 3, 4])
    bar.outline.set_visible(False)  # type: ignore[operator]
    text = "moves the prior leaves open (exponential of its entropy)"
    axes.set_title(text if counted.all() else f"{text}; mauve: never met", fontsize=8.5, weight="normal", pad=4)


def _draw_arrows(axes: "Axes", cells, neighbour, probs, counted, first, beyond) -> None:
    """Arrows in every cell of the window from cell `first` to before `beyond`, with walls as lines."""
    from matplotlib.collections import LineCollection

    rows, columns = beyond - first
    near = cells - first
    draw_prior(axes, (rows, columns), near, probs, counted, wall=_SOLID)
    walls = list(wall_segments(near, neighbour))
    axes.add_collection(LineCollection(walls, colors=INK, linewidths=1.6, capstyle="projecting", zorder=3))
    axes.set(xlim=(-0.5, columns - 0.5), ylim=(rows - 0.5, -0.5), aspect="equal")
    axes.set_anchor("N")


def _frame_close_up(whole: "Axes", close: "Axes", corner: NDArray) -> None:
    from matplotlib.patches import Rectangle

    place = (corner[1] - 0.5, corner[0] - 0.5)
    whole.add_patch(Rectangle(place, CLOSE_UP, CLOSE_UP, fill=False, edgecolor=VERMILION, linewidth=1.8, zorder=9))
    for spine in close.spines.values():
        spine.set(visible=True, color=VERMILION, linewidth=1.8)
