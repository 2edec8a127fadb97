"""O8: two views of a simulated scene registered without their poses, and the contacts that a second view finds.

Each view is in its own camera's frame and has no labels. Refused is an answer; a pose is wrong if it is off by
more than 5° or 20 mm at the middle of the objects. Contacts are judged with labels: one is found if a perceived
contact point lies within 20 mm of it. Intervals of contacts resample scenes.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.tabletop.depth_camera import CAMERAS, Camera
from lifelore.domains.tabletop.photograph import FIRST_OBJECT, Photograph, photograph
from lifelore.domains.tabletop.physics import NEAR as AT_CONTACT
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose, about
from lifelore.domains.tabletop.settings import TabletopScene
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.perception.clouds.fused_views import fused
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.registration.registered_views import registered_views
from lifelore.perception.registration.tabletop_view import tabletop_view
from lifelore.perception.relations.relation_classifier import shipped_model
from lifelore.perception.scene_perception import perceived_scene
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.engine.estimates import exact_share, ratio_or_unmeasured

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


LOT = 5
SEED = 7012
"""Of the scenes; no setting of the registration was chosen on them. The run's seed is added."""
WRONG_TURN, WRONG_SHIFT = 5.0, 0.02
"""Degrees, and metres at the middle of the objects."""
NEAR = 0.02
"""Metres between a true contact and the contact point that finds it."""
ALONE, TRUE, REGISTERED = ("one view", "true poses", "registered")


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots."""
    return lots(settings["scenes"], LOT)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Registrations ``[angle, turn, shift]``, None where refused; found contacts of each scene."""
    pairs, contacts = [], []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        scene = sample_scene(SEED + seed, number, TabletopSettings(shapes="held-out"))
        first, random = Photograph(scene.cloud, scene.clean, scene.view), stream(seed, "O8", "views", number)
        angles = settings["angles"]
        photos = views_around(scene, np.radians(angles).tolist(), CAMERAS["kinect"], random)
        poses = [registered_pose(first, photo) for photo in photos]
        for angle, photo, pose in zip(angles, photos, poses, strict=True):
            pairs.append([angle, *(error_of(pose, photo) if pose is not None else (None, None))])
        clouds, places = [scene.cloud, photos[-1].cloud], true_contacts(scene)
        last = poses[-1]
        joined = {
            ALONE: together(clouds[:1]),
            TRUE: together(clouds),
            REGISTERED: together(clouds[:1]) if last is None else together(clouds, last),
        }
        contacts.append({how: contacts_found(cloud, places) for how, cloud in joined.items()})
    return {"pairs": pairs, "contacts": contacts}


def true_contacts(scene: TabletopScene) -> dict[frozenset[int], NDArray[np.float64]]:
    """Places (k, 3) where two objects touch, by the labels of both; metres in the table's frame."""
    found = Tabletop(scene.shapes, scene.poses).contacts()
    touching = (found.distances < AT_CONTACT / 4) & (np.minimum(found.first, found.second) >= 0)
    pairs = np.sort(np.stack([found.first, found.second], axis=1)[touching], axis=1)
    places = found.positions[touching]
    return {
        frozenset((int(a) + FIRST_OBJECT, int(b) + FIRST_OBJECT)): places[(pairs == (a, b)).all(axis=1)]
        for a, b in np.unique(pairs, axis=0)
    }


def registered_pose(first: Photograph, second: Photograph) -> NDArray[np.float64] | None:
    """(4, 4) where the second view's points in the table's frame come to lie; None where it is refused."""
    try:
        views = [tabletop_view(_in_camera(photo)) for photo in (first, second)]
        place = registered_views(views, ("first", "second"))[1]
    except InputError:
        return None
    return _matrix(first) @ place.pose @ np.linalg.inv(_matrix(second))


def error_of(pose: NDArray[np.float64], photo: Photograph) -> tuple[float, float]:
    """Degrees by which a pose turns too far, and metres at the middle of the objects."""
    objects = photo.clean[photo.cloud.labels > 1]
    middle = np.append((objects.min(axis=0) + objects.max(axis=0)) / 2, 1.0)
    cosine = np.clip((np.trace(pose[:3, :3]) - 1) / 2, -1.0, 1.0)
    return float(np.degrees(np.arccos(cosine))), float(np.linalg.norm((pose @ middle - middle)[:3]))


def _matrix(photo: Photograph) -> NDArray[np.float64]:
    """(4, 4): from the camera's frame to the table's."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = photo.view.rotation, photo.view.position
    return pose


def _in_camera(photo: Photograph) -> PointCloud:
    points = (photo.cloud.points - photo.view.position) @ photo.view.rotation
    return PointCloud(points, camera=np.zeros(3))


def together(clouds: Sequence[LabelledCloud], last: NDArray[np.float64] | None = None) -> LabelledCloud:
    """Clouds as one; a rigid motion `last` (4, 4) moves the last of them first."""
    views = [PointCloud(cloud.points, cloud.labels, cloud.colours, camera=cloud.camera) for cloud in clouds]
    poses = np.stack([np.eye(4)] * len(views))
    if last is not None:
        poses[-1] = last
    whole = fused(views, poses)
    assert whole.labels is not None
    points = whole.points.astype(np.float64)
    return LabelledCloud(points, whole.labels, whole.colours, whole.camera, whole.other_cameras)


def contacts_found(cloud: LabelledCloud, places: Mapping[frozenset[int], NDArray[np.float64]]) -> list[bool]:
    """For each touching pair, whether a contact point between its objects is `NEAR` the true contact."""
    seen = perceived_scene(cloud, shipped_model()).without_unrelated_contacts
    points = {
        frozenset((part.a, part.b)): [node.position for node in (*part.contacts_a, *part.contacts_b)]
        for part in seen.interfaces
    }
    return [
        any(distance_to_hull(point, true) <= NEAR for point in points.get(pair, ()))
        for pair, true in sorted(places.items(), key=lambda item: sorted(item[0]))
    ]


def distance_to_hull(point: NDArray[np.float64], corners: NDArray[np.float64]) -> float:
    """Metres from a point (3,) to the convex hull of `corners` (k, 3)."""
    heavy = 1e3  # non-negative weights of the corners; a heavy last row makes them sum to 1
    ones = np.full(len(corners), heavy)
    return float(nnls(np.vstack([(corners - point).T, ones]), np.array([0.0, 0.0, 0.0, heavy]))[1])


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares registered and wrong, and contacts found more than by one view."""
    pairs = [pair for result in results for pair in result["pairs"]]
    found = {
        "registered": exact_share(turn is not None for _, turn, _ in pairs),
        "wrong": exact_share(t is not None and (t > WRONG_TURN or s > WRONG_SHIFT) for _, t, s in pairs),
    }
    scenes = [scene for result in results for scene in result["contacts"] if scene[ALONE]]
    n = [len(scene[ALONE]) for scene in scenes]
    for name, how in (("true_poses", TRUE), ("registered", REGISTERED)):
        more = [sum(scene[how]) - sum(scene[ALONE]) for scene in scenes]
        found[f"contacts_gained_{name}"] = ratio_or_unmeasured(more, n)
    return found
