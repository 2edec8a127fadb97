"""A sequence of labelled clouds seen by one camera, e.g. a tray after each action of a job."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.figures.scenes.camera_projection import camera_of
from lifelore.figures.scenes.cloud_image import render_cloud
from lifelore.figures.scenes.object_palette import object_palette
from lifelore.figures.style import INK, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZE = (640, 640)
"""Pixels of a picture."""
_WIDE, _CAPTION = 2.2, 0.42
"""Inches: of a picture, and of its caption's height."""
_ROOM = 14
"""Pixels about the objects of all pictures, to which these are cut."""


def draw_cloud_sequence(
    clouds: Sequence[LabelledCloud], captions: Sequence[str], marked: int | None = None, columns: int = 4
) -> "Figure":
    """Pictures in reading order, from the first cloud's camera; objects carry labels and keep their colours.

    Parameters
    ----------
    clouds : sequence of LabelledCloud
        In one frame.
    captions : sequence of str
        One for each cloud; two lines at most.
    marked : int, optional
        Label of an object that a star marks.
    columns : int
        At least 1.

    Raises
    ------
    InputError
        There is no cloud, no column, or not one caption for each cloud.
    """
    if not clouds or columns < 1 or len(captions) != len(clouds):
        raise InputError(
            "a sequence needs clouds, a caption for each and a column, got "
            f"{len(clouds)} clouds, {len(captions)} captions and {columns} columns"
        )
    palette = object_palette({label for cloud in clouds for label in cloud.objects})
    also = np.concatenate([cloud.points[cloud.labels > TABLE] for cloud in clouds])
    camera = camera_of(clouds[0], _SIZE, also)
    columns = min(columns, len(clouds))
    rows = -(-len(clouds) // columns)
    images = [render_cloud(cloud, camera, palette) for cloud in clouds]
    left, right, top, bottom = _window([image.labels for image in images])
    high = _WIDE * (bottom - top) / (right - left)
    with house_style():
        figure = new_figure(columns * _WIDE, rows * (high + _CAPTION))
        grid = figure.subplots(rows, columns, squeeze=False).ravel()
        for axes in grid[len(clouds) :]:
            axes.set_visible(False)
        for axes, cloud, image, caption in zip(grid, clouds, images, captions, strict=False):
            axes.imshow(image.colours, interpolation="bilinear")
            axes.set(xlim=(left, right), ylim=(bottom, top))
            axes.set_axis_off()
            axes.set_title(caption, fontsize=8, loc="left")
            for label in np.intersect1d(cloud.objects, image.labels).tolist():
                x, y = _widest_place(image.labels == label)
                if label == marked:
                    axes.plot(x, y, marker="*", markersize=24, color=PAPER, markeredgecolor=INK)
                colour = INK if label == marked else PAPER
                axes.text(x, y, str(label), ha="center", va="center", fontsize=7, color=colour, weight="bold")
    return figure


def _window(labels: Sequence[NDArray[np.int64]]) -> tuple[int, int, int, int]:
    """Left, right, top and bottom of what holds the objects of every picture, with some room about them."""
    seen = np.any([one > TABLE for one in labels], axis=0)
    if not seen.any():
        seen[:] = True
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    height, width = seen.shape
    return (
        max(int(columns[0]) - _ROOM, 0), min(int(columns[-1]) + _ROOM, width - 1),
        max(int(rows[0]) - _ROOM, 0), min(int(rows[-1]) + _ROOM, height - 1),
    )  # fmt: skip


def _widest_place(seen: NDArray[np.bool_]) -> tuple[int, int]:
    """Column and row of the pixel that is farthest from the edge of what is seen."""
    from scipy.ndimage import distance_transform_edt

    depth = np.asarray(distance_transform_edt(np.pad(seen, 1)))[1:-1, 1:-1]
    row, column = np.unravel_index(int(depth.argmax()), depth.shape)
    return int(column), int(row)
