"""A scene as JSON: the document that ``lifelore perceive --json`` prints.

``{"objects": [{"id", "n_points", "centroid", "contact_points": [{"xyz", "normal", "extent", "strength", "other"}],
"edges", "grasp_seeds": [{"kind", "xyz", "approach", "closing", "width"}]}], "relations": [{"a", "b", "relation",
"confidence", "gap", "stated"}], "facts": ["clear(3)", …], "unknown": [{"fact", "probability", "reason"}], "holes":
[{"objects", "nodes", "xyz", "size", "opening", "centre", "outline"}], "contact_edges": [[[a, i], [b, j]]],
"seconds"}``. `agent.perceive` adds ``"warnings": [{"code", "message"}]``, see `segmentation.scene_warnings`.

Metres, in the scene frame. Objects are named by their numbers, the table ``"table"``; it is no entry of
``objects``. ``edges`` are pairs of numbers into ``contact_points``. A contact edge says that contact point i of a
faces contact point j of b; a hole's ``nodes`` are ends of the same kind in the order of the loop, ``xyz`` their
positions, ``outline`` the border of its opening. An object that was cut automatically also has ``cut_confidence``,
the probability that it is a true object (`cut_confidence.CutCloud`). A relation's ``gap`` is the mean of the five
smallest distances between its two objects' visible points (`near_pairs.visible_gap`). Numbers are finite: an
unknown gap is null.

A relation with a confidence below the threshold stays in ``relations`` with ``stated`` false, and no fact follows
from it. ``unknown`` lists facts of the most likely scene that are not stated: ``doubtful`` ones below the
threshold, ``clear`` of an object whose top other objects hide in part (``hidden``, at any threshold), and ``on``
of an object and the table where the cloud has no table (``no table``).
"""

import math
from collections.abc import Iterable, Mapping

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.contacts.contact_points import ContactPoint
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


def scene_document(
    scene: Scene,
    *,
    seconds: float | None = None,
    min_confidence: float = 0.0,
    cut_confidence: Mapping[int, float] = NOT_CUT,
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

    Raises
    ------
    InputError
        The least probability is outside [0, 1].
    """
    state = scene_state(scene, min_confidence)
    holes = find_holes(scene)
    seeds = grasp_seeds(scene, holes)
    return {
        "objects": [_object(scene, label, seeds, cut_confidence) for label in scene.objects],
        "relations": [_relation(relation, min_confidence) for relation in scene.relations],
        "facts": [str(fact) for fact in sure_facts(scene, state, min_confidence)],
        "unknown": [_unknown(one) for one in state.unknown],
        "holes": [_hole(scene, hole) for hole in holes],
        "contact_edges": [[[_name(e.a), e.node_a], [_name(e.b), e.node_b]] for e in scene.contact_edges],
        "seconds": _number(seconds),
    }


def _object(scene: Scene, label: int, seeds: Iterable[GraspSeed], sure: Mapping[int, float]) -> dict:
    points, network = scene.cloud.of(label), scene.networks[label]
    return {
        "id": _name(label),
        "n_points": len(points),
        "centroid": _numbers(points.mean(axis=0)),
        "contact_points": [_contact(node) for node in network.nodes],
        "edges": network.edges.tolist(),
        "grasp_seeds": [_seed(seed) for seed in seeds if seed.object_id == label],
        **({"cut_confidence": _number(sure[label])} if label in sure else {}),
    }


def _contact(node: ContactPoint) -> dict:
    return {
        "xyz": _numbers(node.position),
        "normal": _numbers(node.normal),
        "extent": _numbers(node.extent),
        "strength": _number(node.strength),
        "other": _name(node.other),
    }


def _seed(seed: GraspSeed) -> dict:
    return {
        "kind": seed.kind,
        "xyz": _numbers(seed.position),
        "approach": _numbers(seed.approach),
        "closing": _numbers(seed.closing),
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
