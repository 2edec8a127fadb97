"""Passages: where a straight stick, closed in all around, passes through the true shapes of a scene.

All sticks run along one axis. Those that clear every true shape are free; free sticks that cannot be moved aside,
clear all the way, until they are out of the scene, are in a passage.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from lifelore.core.errors import InputError
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import BALL, BOX, Shape, ShapePart

GRID = 0.003
"""Metres between sticks, and between places looked at along one."""
MARGIN = 0.002
"""Metres that a stick keeps clear of every shape."""


def passages(shapes: Sequence[Shape], poses: Sequence[Pose], axis: ArrayLike) -> list[NDArray[np.float64]]:
    """Each passage as the places ``(k, 3)`` where its sticks along `axis` cross a plane through the scene.

    The true shapes must be made of boxes and balls, else `InputError` is raised.
    """
    along = np.asarray(axis, float) / np.linalg.norm(axis)
    across = _across(along)
    outline = np.concatenate([pose.apply(shape.outline()) for shape, pose in zip(shapes, poses, strict=True)])
    low, high = (outline @ across.T).min(axis=0) - 4 * GRID, (outline @ across.T).max(axis=0) + 4 * GRID
    x, y = np.meshgrid(*(np.arange(a, b, GRID) for a, b in zip(low, high, strict=True)), indexing="ij")
    starts = np.column_stack([x.ravel(), y.ravel()]) @ across
    depths = outline @ along
    free = np.ones(len(starts), bool)
    for way in np.arange(depths.min() - GRID, depths.max() + GRID, GRID):
        free[free] = ~_inside(starts[free] + way * along, shapes, poses)
    numbers, count = ndimage.label(free.reshape(x.shape))  # type: ignore[misc]
    places = starts + depths.mean() * along
    return [places[numbers.ravel() == k] for k in range(1, count + 1) if k != numbers[0, 0]]


def _across(along: NDArray[np.float64]) -> NDArray[np.float64]:
    """Two unit vectors, rows, at right angles to `along`."""
    first = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    first /= np.linalg.norm(first)
    return np.asarray([first, np.cross(along, first)], np.float64)


def _inside(points: NDArray[np.float64], shapes: Sequence[Shape], poses: Sequence[Pose]) -> NDArray[np.bool_]:
    within = np.zeros(len(points), bool)
    for shape, pose in zip(shapes, poses, strict=True):
        own = (points - pose.position) @ pose.rotation
        for part in shape.parts:
            within |= _inside_part((own - part.position) @ part.rotation, part)
    return within


def _inside_part(points: NDArray[np.float64], part: ShapePart) -> NDArray[np.bool_]:
    if part.kind == BOX:
        return np.asarray((np.abs(points) <= np.array(part.size) + MARGIN).all(axis=1), np.bool_)
    if part.kind == BALL:
        return np.linalg.norm(points, axis=1) <= part.size[0] + MARGIN
    raise InputError(f"shapes must be made of boxes and balls, got a part '{part.kind}'")
