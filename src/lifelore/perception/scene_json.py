"""A scene as JSON: the document that ``lifelore perceive --json`` prints.

``{"frame": {"name", "stamp", "scene_from_camera", "camera_from_scene"}, "objects": [{"id", "n_points",
"centroid", "centroid_camera", "box": {"centre", "axes", "size"}, "box_camera", "top", "support", "colour",
"contact_points": [{"xyz", "normal", "xyz_camera", "normal_camera", "extent", "strength", "other"}], "edges",
"grasp_seeds": [{"kind", "xyz", "approach", "closing", "xyz_camera", "approach_camera", "closing_camera",
"width"}]}], "relations": [{"a", "b", "relation", "confidence", "gap", "stated"}], "facts": ["clear(3)", …],
"unknown": [{"fact", "probability", "reason"}], "holes": [{"objects", "nodes", "xyz", "size", "opening",
"centre", "outline"}], "contact_edges": [[[a, i], [b, j]]], "seconds"}``. `agent.perceive` adds ``"warnings":
[{"code", "message"}]``, see `segmentation.scene_warnings`.

Metres. Places are in the scene's frame (z up, 0 at the table); those whose key ends with ``_camera`` are in the
frame in which the cloud was read, of several views in the first view's. ``scene_from_camera`` and
``camera_from_scene`` are the 4 × 4 motions between the two; ``name`` is that frame's name (frame_id) and
``stamp`` its time in seconds, null where the source does not say. A ``box`` stands upright around the visible
points (`upright_box`); the rows of its ``axes`` are unit vectors, its ``size`` is along them. ``top`` is the
height of the highest visible point, ``support`` the height of what carries the object (`support_height`),
``colour`` the mean red, green and blue, 0 to 255. On request objects have a ``mask`` or ``points``
(`object_mask`).

Objects are named by their numbers, the table ``"table"``; it is no entry of ``objects``. ``edges`` are pairs of
numbers into ``contact_points``. A contact edge says that contact point i of a faces contact point j of b; a
hole's ``nodes`` are ends of the same kind in the order of the loop, ``xyz`` their positions, ``outline`` the
border of its opening. An object that was cut automatically also has ``cut_confidence``, the probability that it
is a true object (`cut_confidence.CutCloud`). A relation's ``gap`` is the mean of the five smallest distances
between its two objects' visible points (`near_pairs.visible_gap`). Numbers are finite: an unknown gap is null.

A relation with a confidence below the threshold stays in ``relations`` with ``stated`` false, and no fact
follows from it. ``unknown`` lists facts of the most likely scene that are not stated: ``doubtful`` ones below
the threshold, ``clear`` of an object whose top other objects hide in part (``hidden``, at any threshold), and
``on`` of an object and the table where the cloud has no table (``no table``).
"""

import math
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.core.cloud_origin import CloudOrigin
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.contacts.contact_points import ContactPoint
from lifelore.perception.places.object_box import ObjectBox, upright_box
from lifelore.perception.places.object_mask import object_mask
from lifelore.perception.places.support_height import support_height
from lifelore.perception.reasoning.planning_state import UnknownFact, scene_state
from lifelore.perception.reasoning.scene_facts import sure_facts
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import TABLE_NAME, Scene
from lifelore.perception.topology.grasp_seeds import GraspSeed, grasp_seeds
from lifelore.perception.topology.holes import Hole, find_holes

NOT_CUT: Mapping[int, float] = {}
"""Confidences of a scene whose labels were given."""
DIGITS = 6
"""Decimals of a metre: a micrometre, far below any sensor's noise."""
_POSE_DIGITS = 9


def scene_document(
    scene: Scene,
    *,
    seconds: float | None = None,
    min_confidence: float = 0.0,
    cut_confidence: Mapping[int, float] = NOT_CUT,
    with_masks: bool = False,
) -> dict:
    """The scene as plain data that ``json.dumps(…, allow_nan=False)`` takes.

    Parameters
    ----------
    scene : Scene
    seconds : float, optional
        How long perception took; null where left out.
    min_confidence : float
        Least probability of a stated relation or fact, in [0, 1].
    cut_confidence : mapping of int to float
        How surely each object was cut, for objects that were cut automatically.
    with_masks : bool
        Whether each object also has its pixels, see `object_mask`.

    Raises
    ------
    InputError
        The least probability is outside [0, 1].
    """
    state = scene_state(scene, min_confidence)
    holes = find_holes(scene)
    seeds = grasp_seeds(scene, holes)
    objects = [_object(scene, label, seeds, min_confidence) for label in scene.objects]
    for label, one in zip(scene.objects, objects, strict=True):
        if label in cut_confidence:
            one["cut_confidence"] = _number(cut_confidence[label])
        if with_masks:
            one.update(object_mask(scene.cloud, label))
    return {
        "frame": _frame(scene.cloud.origin),
        "objects": objects,
        "relations": [_relation(relation, min_confidence) for relation in scene.relations],
        "facts": [str(fact) for fact in sure_facts(scene, state, min_confidence)],
        "unknown": [_unknown(one) for one in state.unknown],
        "holes": [_hole(scene, hole) for hole in holes],
        "contact_edges": [[[_name(e.a), e.node_a], [_name(e.b), e.node_b]] for e in scene.contact_edges],
        "seconds": _number(seconds),
    }


def _frame(origin: CloudOrigin) -> dict:
    return {
        "name": origin.frame.name,
        "stamp": origin.frame.stamp,
        "scene_from_camera": origin.T_scene_camera.round(_POSE_DIGITS).tolist(),
        "camera_from_scene": origin.T_camera_scene.round(_POSE_DIGITS).tolist(),
    }


def _object(scene: Scene, label: int, seeds: Iterable[GraspSeed], least: float) -> dict:
    cloud, network, origin = scene.cloud, scene.networks[label], scene.cloud.origin
    points = cloud.of(label)
    box = upright_box(points)
    return {
        "id": _name(label),
        "n_points": len(points),
        **_places(origin, centroid=points.mean(axis=0)),
        "box": _box(box),
        "box_camera": _box(box.in_camera(origin)),
        "top": _number(points[:, 2].max()),
        "support": _number(support_height(scene, label, least)),
        "colour": _colour(cloud, label),
        "contact_points": [_contact(node, origin) for node in network.nodes],
        "edges": network.edges.tolist(),
        "grasp_seeds": [_seed(seed, origin) for seed in seeds if seed.object_id == label],
    }


def _places(origin: CloudOrigin, **places: NDArray[np.float64]) -> dict:
    """Points (3,) by key in the scene's frame, and in the camera's under the key with ``_camera``."""
    camera = {f"{key}_camera": _numbers(origin.in_camera(place)) for key, place in places.items()}
    return {key: _numbers(place) for key, place in places.items()} | camera


def _directions(origin: CloudOrigin, **directions: NDArray[np.float64]) -> dict:
    """As `_places`, for directions (3,)."""
    camera = {f"{key}_camera": _numbers(origin.turned_to_camera(one)) for key, one in directions.items()}
    return {key: _numbers(one) for key, one in directions.items()} | camera


def _box(box: ObjectBox) -> dict:
    return {
        "centre": _numbers(box.centre),
        "axes": [_numbers(row) for row in box.axes],
        "size": _numbers(box.size),
    }


def _colour(cloud: LabelledCloud, label: int) -> list[int] | None:
    if cloud.colours is None:
        return None
    return cloud.colours[cloud.rows_of(label)].mean(axis=0).round().astype(int).tolist()


def _contact(node: ContactPoint, origin: CloudOrigin) -> dict:
    return {
        **_places(origin, xyz=node.position),
        **_directions(origin, normal=node.normal),
        "extent": _numbers(node.extent),
        "strength": _number(node.strength),
        "other": _name(node.other),
    }


def _seed(seed: GraspSeed, origin: CloudOrigin) -> dict:
    return {
        "kind": seed.kind,
        **_places(origin, xyz=seed.position),
        **_directions(origin, approach=seed.approach, closing=seed.closing),
        "width": _number(seed.width),
    }


def _unknown(one: UnknownFact) -> dict:
    return {"fact": str(one.fact), "probability": _number(one.probability), "reason": one.reason}


def _relation(relation: Relation, least: float) -> dict:
    return {
        "a": _name(relation.a),
        "b": _name(relation.b),
        "relation": relation.relation,
        "confidence": _number(relation.confidence),
        "gap": _number(relation.gap),
        "stated": relation.confidence >= least,
    }


def _hole(scene: Scene, hole: Hole) -> dict:
    return {
        "objects": [_name(label) for label in hole.objects],
        "nodes": [[_name(label), number] for label, number in hole.nodes],
        "xyz": [_numbers(scene.position(label, number)) for label, number in hole.nodes],
        "size": _number(hole.size),
        "opening": _number(hole.opening),
        "centre": _numbers(hole.centre),
        "outline": [_numbers(place) for place in hole.outline],
    }


def _name(label: int) -> int | str:
    return TABLE_NAME if label == TABLE else int(label)


def _number(value: float | None) -> float | None:
    return round(float(value), DIGITS) if value is not None and math.isfinite(value) else None


def _numbers(values: Iterable[float]) -> list[float | None]:
    return [_number(value) for value in values]
