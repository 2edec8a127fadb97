"""A cloud as an image: points splatted front to back, objects in colours of their own, lit so that shape shows."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, UNLABELLED, LabelledCloud
from lifelore.figures.scenes.camera_projection import PictureCamera
from lifelore.figures.scenes.object_palette import mixed, rgb
from lifelore.figures.style import INK, PAPER

_MOST_POINTS = 400_000
"""Points drawn; of larger clouds every so manieth."""
_LARGEST_SPLAT = 21
_LIGHT = np.array([-0.45, -0.75, -0.5]) / np.linalg.norm([-0.45, -0.75, -0.5])
"""Towards the light, in the camera's right, down, forward: from above the viewer's left shoulder."""
_TONES = 22
_EMPTY = -1


@dataclass(frozen=True, eq=False)
class CloudImage:
    """The image and what is seen where.

    Parameters
    ----------
    colours : (height, width, 3) float64
        In [0, 1].
    labels : (height, width) int64
        Label of the foremost point; -1 where there is none.
    """

    colours: NDArray[np.float64]
    labels: NDArray[np.int64]


def render_cloud(cloud: LabelledCloud, camera: PictureCamera, palette: dict[int, str]) -> CloudImage:
    """The cloud seen by `camera`.

    Parameters
    ----------
    cloud : LabelledCloud
    camera : Camera
    palette : dict
        Colour of each object; the table and what has no label are drawn in pale grey.
    """
    from scipy.ndimage import gaussian_filter

    width, height = camera.size
    every = slice(None, None, -(-len(cloud.points) // _MOST_POINTS) or 1)
    pixels, depth = camera.project(cloud.points[every])
    labels = cloud.labels[every]
    inside = np.isfinite(depth) & (pixels >= 0).all(axis=1) & (pixels < [width, height]).all(axis=1)
    pixels, depth, labels = pixels[inside], depth[inside], labels[inside]
    light = _lightness(cloud, every)[inside]
    splat = _splat_size(pixels, labels)
    foremost = _foremost(pixels, depth, camera.size, splat)
    seen = np.where(foremost >= 0, labels[foremost] if len(labels) else _EMPTY, _EMPTY)
    total, picture = np.zeros((height, width, 1)), np.zeros((height, width, 3))
    soft = max(0.7, 0.5 * splat)
    for label in np.unique(seen):
        window = _around(seen == label, 3 * splat)
        here = seen[window] == label
        # Soft masks raised to a power: silhouettes come out smooth where the sensor's grid left stairs.
        weight = gaussian_filter(here.astype(float), soft)[..., None] ** 4
        if label == _EMPTY:
            colour = rgb(PAPER)
        else:
            shade = _shading(depth[foremost[window]], here, camera.scale, splat)
            texture = _smooth(light[foremost[window]], here, (0.5 if label > TABLE else 2) * splat)
            colour = _painted(int(label), palette, shade, texture)
        total[window] += weight
        picture[window] += weight * colour
    return CloudImage(np.clip(picture / total, 0, 1), seen)


def _lightness(cloud: LabelledCloud, every: slice) -> NDArray[np.float64]:
    """How light each point is, in [0, 1], by its colour."""
    if cloud.colours is None:
        return np.full(len(cloud.points[every]), 0.6)
    return cloud.colours[every] @ np.array([0.299, 0.587, 0.114]) / 255


def _splat_size(pixels: NDArray[np.float64], labels: NDArray[np.int64]) -> int:
    """Pixels a point covers so that surfaces close: odd, from the spacing of the objects' points."""
    from scipy.spatial import KDTree

    of_objects = labels > TABLE
    points = pixels[of_objects] if of_objects.sum() > 8 else pixels
    if len(points) <= 8:
        return 5
    some = points[:: -(-len(points) // 3000)]
    # On a grid the fourth neighbour is one spacing away, and nearly so among points scattered at random.
    spacing = float(np.median(KDTree(points).query(some, 5)[0][:, -1]))
    return int(np.clip(2 * round(0.75 * spacing) + 1, 3, _LARGEST_SPLAT))


def _foremost(
    pixels: NDArray[np.float64], depth: NDArray[np.float64], size: tuple[int, int], splat: int
) -> NDArray[np.int64]:
    """Number of the point seen at each pixel, ``(height, width)``; -1 where none is."""
    from scipy.ndimage import minimum_filter

    width, height = size
    rank = np.empty(len(depth))
    rank[np.argsort(depth, kind="stable")] = np.arange(len(depth))
    nearest = np.full(height * width, np.inf)
    column, row = pixels.astype(np.int64).T
    np.minimum.at(nearest, row * width + column, rank)
    nearest = minimum_filter(nearest.reshape(height, width), splat, mode="constant", cval=np.inf)
    order = np.argsort(depth, kind="stable")
    seen = np.full((height, width), -1, np.int64)
    there = np.isfinite(nearest)
    seen[there] = order[nearest[there].astype(np.int64)]
    return seen


def _around(mask: NDArray[np.bool_], margin: int) -> tuple[slice, slice]:
    """The rectangle about what is true in `mask`."""
    window = []
    for axis in (1, 0):
        places = np.flatnonzero(mask.any(axis=axis))
        window.append(slice(max(0, places[0] - margin), places[-1] + margin + 1))
    return window[0], window[1]


def _smooth(values: NDArray[np.float64], here: NDArray[np.bool_], width: float) -> NDArray[np.float64]:
    """Gaussian average over the pixels that belong; what lies outside has no say."""
    from scipy.ndimage import gaussian_filter

    weight = gaussian_filter(here.astype(float), width)
    return gaussian_filter(np.where(here, values, 0.0), width) / np.maximum(weight, 1e-9)


def _shading(depth: NDArray[np.float64], here: NDArray[np.bool_], scale: float, splat: int) -> NDArray[np.float64]:
    """How much light falls on each pixel, in [0, 1], from the slope of the depth."""
    far = np.log(_smooth(depth, here, 1.5 * splat).clip(1e-6))
    down, right = (np.gradient(far, axis=axis) * scale if far.shape[axis] > 1 else 0 * far for axis in (0, 1))
    normal = np.stack([right, down, -np.ones_like(far)], axis=-1)
    facing = normal @ _LIGHT / np.linalg.norm(normal, axis=-1)
    return np.clip(facing, 0, 1)


def _painted(
    label: int, palette: dict[int, str], shade: NDArray[np.float64], texture: NDArray[np.float64]
) -> NDArray[np.float64]:
    if label in palette:
        tone = np.clip(0.06 + 0.88 * shade + 0.3 * (texture - np.mean(texture)), 0, 1)
        # A few tones only: they read as surfaces, and the file stays small.
        tone = np.round(_TONES * tone)[..., None] / _TONES
        return rgb(mixed(palette[label], INK, 0.22)) * (1 - tone) + rgb(mixed(palette[label], PAPER, 0.5)) * tone
    pale = {TABLE: 0.72, UNLABELLED: 0.86}.get(label, 0.72)
    grey = np.round(64 * ((1 - pale) * texture * (0.7 + 0.4 * shade) + pale)) / 64
    return np.repeat(grey[..., None], 3, axis=-1)
