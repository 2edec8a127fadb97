"""Scenes as several segmentations cut them, side by side."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.figures.scenes.camera_projection import PictureCamera, camera_of
from lifelore.figures.scenes.cloud_image import render_cloud
from lifelore.figures.scenes.object_palette import object_palette
from lifelore.figures.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PANEL = (2.6, 2.1)
"""Inches: width and height of a panel."""
_RESOLUTION = 120
"""Pixels an inch of a panel."""
_SIZE = (round(_PANEL[0] * _RESOLUTION), round(_PANEL[1] * _RESOLUTION))


def draw_segmentations(
    scenes: Sequence[tuple[str, NDArray[np.int64], Mapping[str, LabelledCloud]]],
) -> "Figure":
    """A row a scene, a column a method.

    Parameters
    ----------
    scenes : sequence of (name, labels, clouds)
        The true labels ``(n,)``, and the scene's cloud as each method labels it, points in the order of the
        labels. All scenes have the same methods. A segment has the colour of the true object that most of its
        points belong to; further segments of this object have colours of their own.
    """
    methods = list(scenes[0][2])
    with house_style():
        figure = new_figure(_PANEL[0] * len(methods), _PANEL[1] * len(scenes) + 0.4)
        axes = np.reshape(np.asarray(figure.subplots(len(scenes), len(methods))), (len(scenes), len(methods)))
        for row, (name, truth, clouds) in zip(axes, scenes, strict=True):
            row[0].text(-0.06, 0.5, name, rotation=90, va="center", ha="center", transform=row[0].transAxes)
            for axis, method in zip(row, methods, strict=True):
                axis.imshow(segments_picture(truth, clouds[method], _SIZE)[0])
                axis.set_axis_off()
        for axis, method in zip(axes[0], methods, strict=True):
            axis.set_title(method)
    return figure


def segments_picture(
    truth: NDArray[np.int64], cloud: LabelledCloud, size: tuple[int, int]
) -> tuple[NDArray[np.float64], PictureCamera]:
    """Picture (height, width, 3) of a scene in the colours of `coloured_as`, and its camera.

    Parameters
    ----------
    truth : (n,) int64
        True labels of the cloud's points; the true objects are in the middle of the picture.
    cloud : LabelledCloud
        The scene as it is cut, with the camera that has seen it.
    size : (width, height)
        Pixels.
    """
    labels = coloured_as(truth, cloud.labels)
    shown = LabelledCloud(cloud.points, labels, cloud.colours, cloud.camera)
    framed = LabelledCloud(cloud.points, truth, cloud.colours, cloud.camera)
    camera = camera_of(framed, size)
    numbers = range(2, 2 + max(int(truth.max(initial=0)), int(labels.max(initial=0))))
    return render_cloud(shown, camera, object_palette(numbers)).colours, camera


def coloured_as(truth: NDArray[np.int64], labels: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n,) the labels, renumbered after the true objects; a further segment of an object has a new number."""
    shared = np.zeros((int(labels.max(initial=0)) + 1, int(truth.max(initial=0)) + 1), np.int64)
    np.add.at(shared, (labels, truth), 1)
    shared[:, : TABLE + 1] = 0
    number = np.arange(len(shared))
    taken: set[int] = set()
    free = max(shared.shape)
    for segment in np.argsort(-shared.max(axis=1, initial=0), kind="stable").tolist():
        if segment <= TABLE:
            continue
        of = int(shared[segment].argmax())
        if of > TABLE and of not in taken:
            number[segment] = of
            taken.add(of)
        else:
            number[segment] = free
            free += 1
    return number[labels]
