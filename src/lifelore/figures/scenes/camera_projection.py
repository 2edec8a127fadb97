"""Perspective: where points of a scene fall in a picture taken from the cloud's camera, always right way up."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.labelled_cloud import UNLABELLED, LabelledCloud

_THREE_QUARTERS = np.array([0.5, -0.75, 0.55])
"""Towards the camera of a cloud that names none: from the front right, a little above."""
_MARGIN = 0.1
"""Of the objects' width and height, left free on each side."""
_NEAREST = 1e-3
"""Metres before the camera; what is nearer or behind cannot be drawn."""


@dataclass(frozen=True, eq=False)
class PictureCamera:
    """A pinhole camera and the window of its image plane that the picture shows.

    Parameters
    ----------
    position : (3,) float64
        Metres, in the scene frame.
    axes : (3, 3) float64
        Rows: right, down and forward as unit vectors of the scene frame; z of the scene points up in the picture.
    corner : (2,) float64
        Upper left of the window on the image plane at distance 1.
    scale : float
        Pixels by unit of the image plane.
    size : (width, height)
        Pixels.
    """

    position: NDArray[np.float64]
    axes: NDArray[np.float64]
    corner: NDArray[np.float64]
    scale: float
    size: tuple[int, int]

    def project(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Pixel coordinates ``(n, 2)`` (right, down) and depths ``(n,)``; NaN where a point is not before it."""
        plane, depth = _onto_plane(points, self.position, self.axes)
        return (plane - self.corner) * self.scale, depth


def camera_of(cloud: LabelledCloud, size: tuple[int, int], also: ArrayLike = ()) -> PictureCamera:
    """The cloud's own camera, or a three-quarter view, turned and zoomed to its objects.

    Parameters
    ----------
    cloud : LabelledCloud
    size : (width, height)
        Of the picture, pixels.
    also : (m, 3), optional
        Further points that the picture must show.
    """
    subject = np.vstack([_subject(cloud), np.reshape(np.asarray(also, float), (-1, 3))])
    low, high = subject.min(axis=0), subject.max(axis=0)
    middle, reach = (low + high) / 2, max(float(np.linalg.norm(high - low)), 0.05)
    position = cloud.camera
    if position is None or np.linalg.norm(position - middle) < 1e-6:
        position = middle + 2.2 * reach * _THREE_QUARTERS / np.linalg.norm(_THREE_QUARTERS)
    axes = _axes_towards(middle - position)
    plane, _ = _onto_plane(subject, position, axes)
    return PictureCamera(position, axes, *_window(plane[np.isfinite(plane[:, 0])], size), size)


def _subject(cloud: LabelledCloud) -> NDArray[np.float64]:
    """Points the picture is about: the objects, else the table, else anything there is."""
    for wanted in (cloud.labels > 1, cloud.labels != UNLABELLED, np.ones(len(cloud.labels), bool)):
        if wanted.any():
            return cloud.points[wanted]
    return np.zeros((1, 3))


def _axes_towards(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    forward = direction / np.linalg.norm(direction)
    # Straight down no direction is up; the far side of the scene (y) is drawn on top then.
    upright = np.array([0.0, 0.0, 1.0]) if abs(forward[2]) < 0.999 else np.array([0.0, 1.0, 0.0])
    right = np.cross(forward, upright)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(forward, right), forward])


def _onto_plane(
    points: ArrayLike, position: NDArray[np.float64], axes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    seen = (np.reshape(np.asarray(points, float), (-1, 3)) - position) @ axes.T
    depth = np.where(seen[:, 2] > _NEAREST, seen[:, 2], np.nan)
    return seen[:, :2] / depth[:, None], depth


def _window(plane: NDArray[np.float64], size: tuple[int, int]) -> tuple[NDArray[np.float64], float]:
    """Corner and scale of the smallest window of the picture's shape around `plane`, with a margin."""
    if not len(plane):
        plane = np.array([[-0.5, -0.5], [0.5, 0.5]])
    low, high = plane.min(axis=0), plane.max(axis=0)
    extent = np.maximum((high - low) * (1 + 2 * _MARGIN), 1e-3)
    scale = float((np.array(size) / extent).min())
    return (low + high) / 2 - np.array(size) / scale / 2, scale
