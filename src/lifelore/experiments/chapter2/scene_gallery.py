"""Several scenes in a grid, each with its networks and relations (thesis Figs 2.3, 2.6, 2.7, 2.9, 2.10)."""

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.scene_picture import LAYERS, draw_scene_on
from lifelore.figures.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH, _GUTTER, _CAPTION = 9.2, 0.1, 0.26
"""Inches: of the figure, between pictures, and for a caption above each."""
_WIDEST = 4.55


def draw_gallery(
    scenes: Sequence[tuple[LabelledCloud, Mapping, str]], *, columns: int = 3, layers: Collection[str] = LAYERS
) -> "Figure":
    """The grid, row by row.

    Parameters
    ----------
    scenes : sequence of (cloud, document, caption)
        As of `scene_picture.draw_scene`.
    columns : int
        At least 1.
    layers : collection of str
        Which of `scene_picture.LAYERS` to draw.

    Raises
    ------
    InputError
        There is no scene, or no column.
    """
    if not scenes or columns < 1:
        raise InputError(f"a gallery needs a scene and a column, got {len(scenes)} scenes and {columns} columns")
    columns = min(columns, len(scenes))
    rows = -(-len(scenes) // columns)
    wide = min(_WIDEST, (_WIDTH - (columns + 1) * _GUTTER) / columns)
    high = 0.75 * wide
    width, height = columns * (wide + _GUTTER) + _GUTTER, rows * (high + _CAPTION + _GUTTER) + _GUTTER
    with house_style():
        figure = new_figure(width, height)
        figure.set_layout_engine("none")
        for place, (cloud, document, caption) in enumerate(scenes):
            left = _GUTTER + place % columns * (wide + _GUTTER)
            top = height - _GUTTER - _CAPTION - place // columns * (high + _CAPTION + _GUTTER)
            axes = figure.add_axes((left / width, (top - high) / height, wide / width, high / height))
            draw_scene_on(axes, cloud, document, (wide, high), layers)
            axes.set_title(caption, fontsize=8.5, pad=4)
    return figure
