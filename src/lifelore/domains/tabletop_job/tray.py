"""Trays: objects that fell and settled, the object to bring, and what the camera sees of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.streams import stream
from lifelore.domains.tabletop.layout import Placed
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.shapes import Shape
from lifelore.domains.tabletop.tabletop import sample_scene

TARGET_WEIGHT = 7.0
"""Newtons; heavier objects are no targets, so that every gripper can lift the target."""
HINDERED = 0.75
"""Probability that the target is drawn among the hindered objects, where there are any."""
HINDERED_GAP = 0.025
"""Metres: an object nearer to another than this, or pressed by another, is hindered."""


@dataclass(frozen=True, eq=False)
class Tray:
    """A settled tray and its target.

    Parameters
    ----------
    shapes, poses : tuple
        Object by object; the middle of the tray is the origin.
    target : int
        Number of the object to bring.
    cloud : LabelledCloud
        What the depth camera sees, in the table's frame; object k has the label ``k + 2``.
    view : Pose
        Of the camera.
    pointed : (3,) float64
        A seen point of the target, without noise, metres: the user points at it.

    Examples
    --------
    >>> tray = sample_tray(seed=0, number=3)
    >>> tray.target in range(len(tray.shapes)), tray.target + FIRST_OBJECT in tray.cloud.objects
    (True, True)
    """

    shapes: tuple[Shape, ...]
    poses: tuple[Pose, ...]
    target: int
    cloud: LabelledCloud
    view: Pose
    pointed: NDArray[np.float64]


def sample_tray(seed: int, number: int, settings: TabletopSettings | None = None) -> Tray:
    """Tray `number` of a seed; the same for the same arguments. The last 64 trays are cached, some 3 MB each.

    Raises
    ------
    MissingExtraError
        MuJoCo is not installed.
    InputError
        The settings name something unknown or have a mix, or no scene of a hundred has an object light enough.

    Examples
    --------
    >>> tray = sample_tray(seed=0, number=3)
    >>> tray is sample_tray(seed=0, number=3)
    True
    >>> len(tray.poses) == len(tray.shapes)
    True
    """
    settings = settings or TabletopSettings()
    if settings.mix is not None:
        raise InputError(f"mix must be None for trays, got {dict(settings.mix)}; leave it out")
    return _sampled(seed, number, settings)


@lru_cache(maxsize=64)
def _sampled(seed: int, number: int, settings: TabletopSettings) -> Tray:
    for attempt in range(100):
        scene = sample_scene(seed, 1000 * number + attempt, settings)
        table = Tabletop(scene.shapes, scene.poses)
        light = np.flatnonzero(table.weights <= TARGET_WEIGHT)
        if not len(light):
            continue
        rng = stream(seed, "tabletop job", "target", number)
        hindered = np.intersect1d(light, hindered_objects(table))
        choice = hindered if len(hindered) and rng.random() < HINDERED else light
        target = int(rng.choice(choice))
        seen = scene.clean[scene.cloud.labels == target + FIRST_OBJECT]
        pointed = seen[np.linalg.norm(seen - np.median(seen, axis=0), axis=1).argmin()]
        return Tray(scene.shapes, scene.poses, target, scene.cloud, scene.view, pointed)
    raise InputError(f"no scene of {settings} has an object below {TARGET_WEIGHT} N: change shapes or n_objects")


def tray_of(placed: Sequence[Placed], target: int) -> Tray:
    """A tray of objects placed by hand, without a picture: its cloud is empty."""
    shapes, poses = tuple(item.shape for item in placed), tuple(item.pose for item in placed)
    empty = LabelledCloud(np.empty((0, 3)), np.empty(0, np.int64))
    return Tray(shapes, poses, target, empty, Pose(np.zeros(3), np.eye(3)), poses[target].position)


def hindered_objects(table: Tabletop) -> NDArray[np.int64]:
    """Objects that another presses from above, or to which another is nearer than `HINDERED_GAP`, ascending."""
    contacts = table.contacts()
    upward = contacts.forces[:, 2]
    # The force acts on the second body: where it points down, the first presses the second from above.
    pressed = np.where(upward < 0, contacts.second, contacts.first)
    found = set(pressed[(np.abs(upward) > 0.05) & (contacts.first >= 0) & (contacts.second >= 0)].tolist())
    n = len(table.shapes)
    for i in range(n):
        for j in range(i + 1, n):
            distance, along = table.distance(i, j, HINDERED_GAP)
            if distance < HINDERED_GAP and np.hypot(along[0], along[1]) > abs(along[2]):
                found |= {i, j}
    return np.array(sorted(found), dtype=np.int64)
