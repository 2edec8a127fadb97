"""`bench registration`: two views of a simulated scene registered without their poses, and what the second gives.

A view is registered from its points alone, in its own camera's frame, without labels. Refused is an answer; a pose
that is off by more than `WRONG_TURN` or `WRONG_SHIFT` is wrong. The second view at 90° is then fused with the
first by its true pose and as it was registered; a scene whose registration is refused has one view. Relations and
contacts are judged as in `views`, on the same pairs with and without a second view. The scenes' shapes are unknown
to the shipped model, and none of the scenes was used to choose the settings of the registration.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.perception.views import SHAPES, contacts_found, lasting_labels, together
from benchmarks.rounds import estimated_row, row
from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.photograph import Photograph
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, tabletop_scenes
from lifelore.domains.tabletop.views import true_contacts, views_around
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.registration.registered_views import registered_views
from lifelore.perception.registration.tabletop_view import tabletop_view
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from reproduction.chapter2.scoring.relation_scoring import (
    JudgedPair,
    difference,
    judged_scene,
    share,
    share_over_scenes,
)

SEED = 7012
SCENES = 20
"""Scenes of a round; each has a pair of views for each of `ANGLES`."""
ANGLES = (20, 45, 90)
"""Degrees between the two cameras."""
WRONG_TURN, WRONG_SHIFT = 5.0, 0.02
"""Degrees, and metres at the middle of the objects."""
ALONE, TRUE, REGISTERED = "1 view", "2 views, true poses", "2 views, registered"


@dataclass(frozen=True, eq=False)
class RegisteredPair:
    """A registration of two views and its error.

    Parameters
    ----------
    angle : int
        Degrees between the cameras.
    pose : (4, 4) float64, optional
        Where the second view's points in the table's frame come to lie; None where registration was refused.
    turn, shift : float
        Degrees; metres at the middle of the objects. NaN where it was refused.
    """

    angle: int
    pose: NDArray[np.float64] | None
    turn: float
    shift: float

    @property
    def is_wrong(self) -> bool:
        return self.pose is not None and (self.turn > WRONG_TURN or self.shift > WRONG_SHIFT)


@dataclass(frozen=True)
class RegisteredScene:
    """A scene's registrations; its judged pairs and found contacts by `ALONE`, `TRUE` and `REGISTERED`."""

    pairs: list[RegisteredPair]
    judged: dict[str, list[JudgedPair]]
    contacts: dict[str, list[bool]]


def bench_registration(repeats: int, progress: Progress) -> dict:
    """Rows without goals; see `benchmarks.bench`. Each round adds `SCENES` scenes."""
    model, n = shipped_model(), SCENES * repeats
    found = []
    for number, scene in enumerate(tabletop_scenes(n, SEED, TabletopSettings(shapes=SHAPES))):
        found.append(registered_scene(scene, number, model))
        progress(number + 1, n, scene.name)
    return {"rows": registration_rows([scene.pairs for scene in found]) + _gain_rows(found), "goals": []}


def registered_scene(scene: TabletopScene, number: int, model: RelationClassifier) -> RegisteredScene:
    """What the views of a scene give."""
    first = Photograph(scene.cloud, scene.clean, scene.view)
    photos = views_around(
        scene, np.radians(ANGLES).tolist(), CAMERAS["kinect"], stream(SEED, "tabletop registration", number)
    )
    pairs = [registered(first, photo, angle) for photo, angle in zip(photos, ANGLES, strict=True)]
    clouds, pose = [scene.cloud, photos[-1].cloud], pairs[-1].pose
    joined = {ALONE: together(clouds[:1]), TRUE: together(clouds)}
    joined[REGISTERED] = joined[ALONE] if pose is None else together(clouds, pose)
    labels, places = lasting_labels(scene, photos[-1:]), true_contacts(scene)
    judged, contacts = {}, {}
    for how, cloud in joined.items():
        seen = perceived_scene(cloud, model).without_unrelated_contacts
        judged[how] = judged_scene(scene.name, labels, seen.relations)
        contacts[how] = contacts_found(seen, places)
    return RegisteredScene(pairs, judged, contacts)


def registered(first: Photograph, second: Photograph, angle: int) -> RegisteredPair:
    """Register the second photograph to the first."""
    try:
        views = [tabletop_view(_in_camera(photo)) for photo in (first, second)]
        place = registered_views(views, ("first", "second"))[1]
    except InputError:
        return RegisteredPair(angle, None, np.nan, np.nan)
    # From the table's frame by the second camera to the first, and by the first camera's true pose back.
    pose = _matrix(first) @ place.pose @ np.linalg.inv(_matrix(second))
    cosine = (np.trace(pose[:3, :3]) - 1) / 2
    objects = second.clean[second.cloud.labels > 1]
    middle = np.append((objects.min(axis=0) + objects.max(axis=0)) / 2, 1.0)
    shift = float(np.linalg.norm((pose @ middle - middle)[:3]))
    return RegisteredPair(angle, pose, float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))), shift)


def _matrix(photo: Photograph) -> NDArray[np.float64]:
    """(4, 4): from the camera's frame to the table's."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = photo.view.rotation, photo.view.position
    return pose


def _in_camera(photo: Photograph) -> PointCloud:
    points = (photo.cloud.points - photo.view.position) @ photo.view.rotation
    return PointCloud(points, camera=np.zeros(3))


def registration_rows(scenes: Sequence[Sequence[RegisteredPair]]) -> list[dict]:
    """Rows for each angle and for all of them: shares of the pairs, and errors of what was not refused."""
    rows = []
    for angle in (*ANGLES, None):
        name = "all angles" if angle is None else f"cameras {angle}° apart"
        own = [[pair for pair in pairs if angle in (None, pair.angle)] for pairs in scenes]
        for word, counts in (
            ("refused", [sum(pair.pose is None for pair in pairs) for pairs in own]),
            ("wrong", [sum(pair.is_wrong for pair in pairs) for pairs in own]),
        ):
            share = share_over_scenes(counts, [len(pairs) for pairs in own])
            rows.append(estimated_row(f"registration {word}, {name}", share, "share"))
        found = [pair for pairs in own for pair in pairs if pair.pose is not None]
        for word, unit, errors in (
            ("turn", "degrees", [pair.turn for pair in found]),
            ("shift", "mm", [1000 * pair.shift for pair in found]),
        ):
            for level, percent in (("median", 50), ("95th percentile", 95)):
                value = float(np.percentile(errors, percent)) if errors else None
                rows.append(
                    {**row(f"registration error of {word}, {level}, {name}", value, unit), "n": len(errors)}
                )
    return rows


def _gain_rows(found: Sequence[RegisteredScene]) -> list[dict]:
    """Rows for relations and contacts with one view and with a second view, and their differences."""
    one = [pair for scene in found for pair in scene.judged[ALONE]]
    rows = []
    for how in (ALONE, TRUE, REGISTERED):
        judged = [pair for scene in found for pair in scene.judged[how]]
        touching = [scene.contacts[how] for scene in found if scene.contacts[how]]
        measures: Mapping[str, Estimate] = {
            "exact": share(judged, lambda pair: pair.exact),
            "on": share(judged, lambda pair: pair.on_right),
            "contacts found": share_over_scenes([sum(own) for own in touching], [len(own) for own in touching]),
        }
        if how != ALONE:
            measures = {**measures, "exact less 1 view": difference(judged, one)}
        rows += [estimated_row(f"{name}, {how}", number, "share") for name, number in measures.items()]
    return rows
