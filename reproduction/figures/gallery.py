"""A gallery: perceived scenes in a grid, with room for charts below (thesis Figs 2.3, 2.6, 2.7, 2.9, 2.10)."""

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.scenes.scene_picture import LAYERS, draw_scene_on
from lifelore.figures.style import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure, FigureBase, SubFigure

_WIDTH, _GUTTER, _CAPTION = 9.2, 0.1, 0.26
"""Inches: of the figure, between pictures, and for a caption above each."""
_WIDEST = 4.55
PictureOfScene = tuple[LabelledCloud, Mapping, str]
"""A cloud and its document, as of `scene_picture.draw_scene`, and a caption."""


def draw_gallery(
    scenes: Sequence[PictureOfScene], *, columns: int = 3, layers: Collection[str] = LAYERS
) -> "Figure":
    """The pictures in a grid, row by row.

    Parameters
    ----------
    scenes : sequence of (cloud, document, caption)
    columns : int
        At least 1.
    layers : collection of str
        Which of `scene_picture.LAYERS` to draw.
    """
    columns = min(columns, len(scenes))
    wide, high = _size(columns)
    rows = -(-len(scenes) // columns)
    size = (columns * (wide + _GUTTER) + _GUTTER, rows * (high + _CAPTION + _GUTTER) + _GUTTER)
    figure = new_figure(*size)
    figure.set_layout_engine("none")
    _draw(figure, size, scenes, columns, layers)
    return figure


def gallery_above(
    scenes: Sequence[PictureOfScene], below: float, *, columns: int = 3, layers: Collection[str] = LAYERS
) -> tuple["Figure", "SubFigure"]:
    """A figure with a row of pictures, and its lower part of `below` inches for charts."""
    _, high = _size(columns)
    above = high + _CAPTION + 2 * _GUTTER if scenes else 0.01
    figure = new_figure(_WIDTH, above + below)
    top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=[above, below])[:, 0]
    _draw(top, (_WIDTH, above), scenes[:columns], columns, layers)
    return figure, bottom


def _size(columns: int) -> tuple[float, float]:
    wide = min(_WIDEST, (_WIDTH - (columns + 1) * _GUTTER) / columns)
    return wide, 0.75 * wide


def _draw(
    figure: "FigureBase",
    size: Sequence[float],
    scenes: Sequence[PictureOfScene],
    columns: int,
    layers: Collection[str],
) -> None:
    (wide, high), (width, height) = _size(columns), size
    for place, (cloud, document, caption) in enumerate(scenes):
        left = _GUTTER + place % columns * (wide + _GUTTER)
        top = height - _GUTTER - _CAPTION - place // columns * (high + _CAPTION + _GUTTER)
        axes = figure.add_axes((left / width, (top - high) / height, wide / width, high / height))
        axes.set_in_layout(False)
        draw_scene_on(axes, cloud, document, (wide, high), layers)
        axes.set_title(caption, fontsize=8.5, pad=4)
