"""Further photographs of a settled scene, from cameras turned about the vertical axis through its objects."""

from collections.abc import Sequence

import numpy as np

from lifelore.domains.tabletop.depth_camera import Camera
from lifelore.domains.tabletop.photograph import Photograph, photograph
from lifelore.domains.tabletop.physics import Tabletop
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
    table = Tabletop(scene.shapes, scene.poses)
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
