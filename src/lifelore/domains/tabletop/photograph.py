"""A photograph of a settled tabletop: where the camera stands, and the labelled cloud it sees."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.domains.tabletop.depth_camera import Camera, looking_down, measure
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose

FIRST_OBJECT = 2
FEW_POINTS = 400
"""An object with fewer seen points is hidden."""
_MARGIN = 40
_FARTHEST = 2.5


@dataclass(frozen=True, eq=False)
class Photograph:
    """The cloud in the table's frame, its points without noise ``(n, 3)``, and the camera's pose."""

    cloud: LabelledCloud
    clean: NDArray[np.float64]
    view: Pose


def choose_view(outlines: list[NDArray[np.float64]], rng: np.random.Generator, camera: Camera) -> Pose | None:
    """A camera as a person sets one down, 30° to 50° down, further off until all is in the picture; None if never.

    The real scenes of the thesis's kind are seen from 0.6 m over the table at 33° to 45°, 0.55 to 0.95 m deep.
    """
    points = np.concatenate(outlines)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2 * [1, 1, 0]
    for further in 0.9 * np.linspace(0.0, 1.0, 24) ** 2:
        tilt, roll = np.radians(rng.uniform(30, 50)), rng.normal(0, 0.03)
        height = rng.uniform(0.5, 0.7) + 0.3 * further
        view = looking_down(height, tilt, roll, rng.uniform(0.6, 0.86) + further)
        view = view.moved(middle + np.append(rng.normal(0, 0.03, 2), 0.0))
        local = (points - view.position) @ view.rotation
        if local[:, 2].min() > 0.4:
            pixels = camera.project(local)
            if (pixels > 4).all() and (pixels < [camera.width - 4, camera.height - 4]).all():
                return view
    return None


def photograph(
    table: Tabletop,
    outlines: list[NDArray[np.float64]],
    view: Pose,
    camera: Camera,
    rng: np.random.Generator,
    fewest: int = FEW_POINTS,
    coloured: bool = True,
) -> Photograph | None:
    """What the camera sees of the objects and of the table; None where an object has less than `fewest` points."""
    rays = _rays_at(outlines, view, camera)
    world = rays.reshape(-1, 3) @ view.rotation.T
    hits, depth, normals = table.cast(view.position, world)
    floor = np.where(world[:, 2] < -1e-6, view.position[2] / -np.minimum(world[:, 2], -1e-6), np.inf)
    on_table = floor < depth
    depth = np.minimum(depth, floor)
    noisy = measure(depth.reshape(rays.shape[:2]), camera, rng).ravel()
    seen = np.flatnonzero(np.isfinite(noisy) & (depth < _FARTHEST))
    labels = np.where(on_table, TABLE, hits + FIRST_OBJECT)[seen]
    if np.bincount(labels, minlength=FIRST_OBJECT + len(outlines))[FIRST_OBJECT:].min() < fewest:
        return None
    normals[on_table] = (0.0, 0.0, 1.0)
    colours = _colours(labels, normals[seen], rng) if coloured else None
    cloud = LabelledCloud(view.position + world[seen] * noisy[seen, None], labels, colours, view.position)
    return Photograph(cloud, view.position + world[seen] * depth[seen, None], view)


def _rays_at(outlines: list[NDArray[np.float64]], view: Pose, camera: Camera) -> NDArray[np.float64]:
    """Rays ``(rows, columns, 3)`` of the part of the picture that holds the objects."""
    pixels = camera.project((np.concatenate(outlines) - view.position) @ view.rotation)
    low = np.maximum(np.floor(pixels.min(axis=0)).astype(int) - _MARGIN, 0)
    high = np.minimum(np.ceil(pixels.max(axis=0)).astype(int) + _MARGIN, [camera.width, camera.height])
    return camera.rays(np.arange(low[0], high[0])[None], np.arange(low[1], high[1])[:, None])


def _colours(
    labels: NDArray[np.int64], normals: NDArray[np.float64], rng: np.random.Generator
) -> NDArray[np.uint8]:
    """A colour an object, shaded by a light from above, with a little noise."""
    palette = rng.uniform(40, 235, (int(labels.max()) + 1, 3))
    palette[TABLE] = (196, 172, 140)
    light = 0.55 + 0.45 * np.clip(normals @ np.array([0.3, -0.4, 0.866]), 0, 1)
    noisy = palette[labels] * light[:, None] + rng.normal(0, 4, (len(labels), 1))
    return np.clip(noisy, 0, 255).astype(np.uint8)
