"""Measures and rows of claim C2.13: nodes of the L-block, and how often each method predicts *on*."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.core.relations import ON, SYMMETRIC
from lifelore.perception.peers import PEERS
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.c2_13_contacts_and_centres.run import LESSON, NODES, SCENE
from reproduction.chapter2.scenes.tabletop_pairs import KERNELS, STANDARD, Row, kernel_name
from reproduction.chapter2.scoring.pair_validation import (
    THRESHOLD,
    Reading,
    as_scene,
    as_seen,
    classified,
    votes_of_neighbours,
    votes_on,
)
from reproduction.chapter2.scoring.relation_scoring import JudgedPair, difference
from reproduction.engine.estimates import exact_share, is_below, mean_or_unmeasured, share_of

CONTACTS, CENTRES, OURS = "contacts", "centres", "lifelore"
OTHERS = {"closest_points": "closest-point k-NN", "bounding_boxes": "bounding-box rule"}


def lessons_and_scenes(results: Sequence[Mapping], camera: str) -> tuple[list[Row], list[Row]]:
    """The rows of lessons, and of scenes, of a camera."""
    lessons, scenes = (
        [row for r in results if (r["kind"], r["camera"]) == (kind, camera) for row in r["rows"]]
        for kind in (LESSON, SCENE)
    )
    return lessons, scenes


def nodes(row: Row, kernel: str = STANDARD) -> np.ndarray:
    """Height (metres) and support vectors of each of the block's nodes, none dropped, ``(n, 2)``."""
    return np.array(row["contacts"][kernel]["a"], float).reshape(-1, 4)[:, 2:]


def strong(found: np.ndarray) -> np.ndarray:
    """The nodes of at least `THRESHOLD` support vectors."""
    return found[found[:, 1] >= THRESHOLD]


def topmost_alone_remains(found: np.ndarray) -> bool:
    """Whether one node is strong and no other is higher."""
    kept = strong(found)
    return len(kept) == 1 and bool(kept[0, 0] >= found[:, 0].max())


def node_measures(scenes: Sequence[Row], kernel: str = STANDARD) -> dict[str, Estimate]:
    """Shares of scenes by the block's nodes, with the threshold and without."""
    found = [nodes(row, kernel) for row in scenes]
    n, left = [len(all_nodes) for all_nodes in found], [len(strong(all_nodes)) for all_nodes in found]
    return {
        "rank_of_three_nodes": mean_or_unmeasured((k < NODES) + 0.5 * (k == NODES) for k in n),
        "several_nodes_without_threshold": exact_share(k > 1 for k in n),
        "one_node_with_threshold": exact_share(k == 1 for k in left),
        "kept_node_is_topmost": exact_share(map(topmost_alone_remains, found)),
    }


def node_counts(scenes: Sequence[Row], kernel: str) -> dict[str, list[int]]:
    """How many scenes have 0, 1, 2, 3, and more nodes, of all contacts and of strong ones."""
    found = [nodes(row, kernel) for row in scenes]
    counted = {"every contact": map(len, found), "strong": (len(strong(own)) for own in found)}
    capped = {name: [min(k, NODES + 1) for k in n] for name, n in counted.items()}
    return {name: np.bincount(n, minlength=NODES + 2).tolist() for name, n in capped.items()}


def inferred(lessons: Sequence[Row], scenes: Sequence[Row]) -> dict[str, list[JudgedPair]]:
    """By method the judged pairs of scenes, the direction inferred."""
    displacement = RelationClassifier("displacement", symmetric=SYMMETRIC)
    models: dict[str, tuple[Any, Any]] = {
        CONTACTS: (displacement, as_scene),
        CENTRES: (PEERS["centroid k-NN"](), as_seen("centroid k-NN")),
        OURS: (RelationClassifier(symmetric=SYMMETRIC), as_scene),
        **{name: (PEERS[peer](), as_seen(peer)) for name, peer in OTHERS.items()},
    }
    found = {}
    for name, (model, look) in models.items():
        viewed = (
            [(row, look(row) if row["gap"] is not None else None) for row in rows] for rows in (lessons, scenes)
        )
        found[name] = classified(model, *viewed)
    return found


def given(lessons: Sequence[Row], scenes: Sequence[Row]) -> dict[str, list[str]]:
    """The relation of each scene with A and B given, by displacements of contact points and of centres."""
    rows = [row for row in [*lessons, *scenes] if row["gap"] is not None]
    train = np.arange(len(rows)) < len(rows) - sum(row["gap"] is not None for row in scenes)
    owner = np.arange(len(rows))
    by_contacts = votes_of_neighbours(rows, Reading(), train)
    by_centres = votes_on(np.array([centres_apart(row) for row in rows]), owner, rows, Reading(), train)
    first = int(train.sum())
    return {CONTACTS: by_contacts.relations(len(rows))[first:], CENTRES: by_centres.relations(len(rows))[first:]}


def centres_apart(row: Row) -> np.ndarray:
    """From B's centre of mass to A's, in the order of the truth, ``(3,)``, metres."""
    forward, backward = np.array(row["peers"]["centroid k-NN"])
    return forward if row["a"] == row["pair"][0] else backward


def on_measures(lessons: Sequence[Row], scenes: Sequence[Row]) -> dict[str, Estimate]:
    """Shares of scenes predicted to be on(ball, block), by method; distances of the centres."""
    judged = inferred(lessons, scenes)
    found = {f"on_by_{name}": exact_share(pair.exact for pair in pairs) for name, pairs in judged.items()}
    found["on_by_contacts_less_by_centres"] = difference(judged[CONTACTS], judged[CENTRES])
    for name, relations in given(lessons, scenes).items():
        found[f"on_by_{name}_in_given_order"] = exact_share(relation == ON for relation in relations)
    away = 1000 * np.array([centres_apart(row) for row in scenes if row["gap"] is not None]).reshape(-1, 3)
    found["mm_of_centres_apart_sideways"] = mean_or_unmeasured(np.hypot(away[:, 0], away[:, 1]))
    found["mm_of_centres_apart_upwards"] = mean_or_unmeasured(away[:, 2])
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Nodes and *on* by the first camera; by another camera with its name at the end.

    Then the share of cameras and kernels in which all that the thesis says holds by its intervals.
    """
    found, grid = {}, []
    for number, camera in enumerate(settings["cameras"]):
        lessons, scenes = lessons_and_scenes(results, camera)
        ending = f"_{camera}" if number else ""
        measured = node_measures(scenes) | on_measures(lessons, scenes)
        found |= {f"{name}{ending}": estimate for name, estimate in measured.items()}
        for kernel in KERNELS:
            own = node_measures(scenes, kernel_name(*kernel))
            told = at_least_nine_in_ten(measured["on_by_contacts"]) and is_below(measured["on_by_centres"], 0.9)
            kept = [own["one_node_with_threshold"], own["kept_node_is_topmost"]]
            grid.append(told and all(map(at_least_nine_in_ten, kept)))
    return found | {"cameras_and_kernels_in_which_all_is_so": share_of(grid)}


def at_least_nine_in_ten(share: Estimate) -> bool:
    """Whether the whole interval of a share reaches 90 %, as the conditions ask."""
    return share.ci95 is not None and share.ci95[0] >= 0.9


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Scenes by number of nodes, by kernel and camera; how often each method predicts a relation; pictures."""
    found: list[dict] = []
    for camera in settings["cameras"]:
        lessons, scenes = lessons_and_scenes(results, camera)
        for kernel in KERNELS:
            name = kernel_name(*kernel)
            found.append({"camera": camera, "kernel": name, "scenes by nodes": node_counts(scenes, name)})
        for method, pairs in inferred(lessons, scenes).items():
            words = Counter(f"{pair.relation}{'' if pair.same_way else ', turned'}" for pair in pairs)
            found.append({"camera": camera, "method": method, "said": dict(sorted(words.items()))})
        for result in results:
            if result["camera"] == camera:
                found += [row | {"example": f"{camera}, {row['example']}"} for row in result["examples"]]
    return found
