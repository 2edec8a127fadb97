"""Further photographs of a settled scene, from cameras turned about the vertical axis through its objects."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop.depth_camera import Camera
from lifelore.domains.tabletop.photograph import FIRST_OBJECT, Photograph, photograph
from lifelore.domains.tabletop.physics import NEAR, Tabletop
from lifelore.domains.tabletop.pose import Pose, about
from lifelore.domains.tabletop.settings import TabletopScene

Z = 2


def views_around(
    scene: TabletopScene, turns: Sequence[float], camera: Camera, rng: np.random.Generator
) -> list[Photograph]:
    """Photographs of a scene by the scene's camera turned about its objects.

    Parameters
    ----------
    scene : TabletopScene
    turns : sequence of float
        Radians about the vertical axis through the middle of the objects.
    camera : Camera
        The camera that took the scene's cloud.
    rng : Generator
        Draws the noise.

    Returns
    -------
    list of Photograph
        One for each turn, in the table's frame; an object may be hidden in some of them.
    """
    table = Tabletop(scene.shapes, scene.poses).rigid()
    outlines = [pose.apply(shape.outline()) for shape, pose in zip(scene.shapes, scene.poses, strict=True)]
    points = np.concatenate(outlines)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    photos = []
    for turn in turns:
        rotation = about(Z, turn)
        view = Pose(middle + rotation @ (scene.view.position - middle), rotation @ scene.view.rotation)
        photo = photograph(table, outlines, view, camera, rng, fewest=0)
        assert photo is not None
        photos.append(photo)
    return photos


def true_contacts(scene: TabletopScene) -> dict[frozenset[int], NDArray[np.float64]]:
    """Places (k, 3) where two objects touch, by the labels of both; metres in the table's frame."""
    found = Tabletop(scene.shapes, scene.poses).contacts()
    touching = (found.distances < NEAR / 4) & (np.minimum(found.first, found.second) >= 0)
    pairs = np.sort(np.stack([found.first, found.second], axis=1)[touching], axis=1)
    places = found.positions[touching]
    return {
        frozenset((int(a) + FIRST_OBJECT, int(b) + FIRST_OBJECT)): places[(pairs == (a, b)).all(axis=1)]
        for a, b in np.unique(pairs, axis=0)
    }
