"""Grasp seeds: where a search for a grasp may begin, from the edges of networks and from holes.

Between two contact points of an object lies the part of it that bears on nothing; there a hand may close around it
(§2.1: edges "provide seeding regions, around which the search for grasp points can begin"). A hole is a place to
put a finger through. Seeds are *candidates*: neither reach, nor collision, nor friction is checked, and widths are
of the visible points only, so they are lower bounds of the object's own.

Thesis: §2.1, §2.4.2, §2.5.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.scene import Scene
from lifelore.perception.topology.holes import Hole, find_holes

HAND = 0.02
"""Metres along the edge over which the object's width is measured: the breadth of two fingers."""

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class GraspSeed:
    """A pose to begin a search with.

    Parameters
    ----------
    object_id : int
        What would be grasped.
    kind : {"edge", "hole"}
    position : (3,) float64
        Between the fingers, metres.
    approach : (3,) float64
        Unit vector along which the hand comes.
    closing : (3,) float64
        Unit vector along which the fingers close, at right angles to `approach`.
    width : float
        How far the fingers must open: the object's visible width along `closing`, or a hole's opening, metres.
    """

    object_id: int
    kind: str
    position: NDArray[np.float64]
    approach: NDArray[np.float64]
    closing: NDArray[np.float64]
    width: float


def grasp_seeds(scene: Scene, holes: tuple[Hole, ...] | None = None) -> tuple[GraspSeed, ...]:
    """Seeds of all objects, those from edges first; the table is not to be grasped.

    Parameters
    ----------
    scene : Scene
    holes : tuple of Hole, optional
        Those of `find_holes`; found anew when left out.
    """
    found = find_holes(scene) if holes is None else holes
    points_of = cache(scene.cloud.of)
    edges = (
        _edge_seed(scene, label, i, j, points_of(label))
        for label in scene.objects
        for i, j in scene.networks[label].edges
    )
    through = (_hole_seed(scene, hole) for hole in found)
    return tuple(seed for seed in (*edges, *through) if seed is not None)


def _edge_seed(scene: Scene, label: int, i: int, j: int, own: NDArray[np.float64]) -> GraspSeed | None:
    """At the middle of an edge, the fingers closing across it; None where no point of the object is near."""
    start, end = scene.position(label, i), scene.position(label, j)
    along, length = _unit(end - start)
    if length == 0:
        return None
    middle = (start + end) / 2
    points = own - middle
    near = points[np.abs(points @ along) <= HAND / 2]
    if not len(near):
        return None
    approach = _approach(along, scene, middle)
    closing = np.cross(along, approach)
    reach = near @ closing
    # The hand is centred on what it closes around, not on the line between two contacts at the surface.
    position = middle + closing * (reach.max() + reach.min()) / 2
    return GraspSeed(label, "edge", position, approach, closing, float(reach.max() - reach.min()))


def _approach(along: NDArray[np.float64], scene: Scene, middle: NDArray[np.float64]) -> NDArray[np.float64]:
    """At right angles to the edge: from above, or, along an upright edge, from the camera's side."""
    down, length = _unit(-UP + (UP @ along) * along)
    if length > 0.5:
        return down
    seen_from = scene.cloud.camera if scene.cloud.camera is not None else middle + np.array([1.0, 0.0, 0.0])
    ahead = (middle - seen_from) - ((middle - seen_from) @ along) * along
    side, length = _unit(ahead)
    return side if length > 0 else _unit(np.cross(along, [1.0, 0.0, 0.0]) + np.cross(along, [0.0, 1.0, 0.0]))[0]


def _hole_seed(scene: Scene, hole: Hole) -> GraspSeed | None:
    """Through the middle of a hole, to lift the topmost of its objects (§2.4.2: "from underneath")."""
    things = [label for label in hole.objects if label != TABLE]
    top = max(things, key=lambda label: (float(scene.cloud.of(label)[:, 2].mean()), -label))
    at = np.array([scene.position(*node) for node in hole.nodes]) - hole.centre
    # The way through is across the plane that fits the loop best.
    through = np.linalg.svd(at)[2][-1]
    through *= _sign(through, scene, hole.centre)
    closing, length = _unit(UP - (UP @ through) * through)
    if length == 0:
        closing = _unit(at[0])[0]
    return GraspSeed(top, "hole", hole.centre, through, closing, hole.opening)


def _sign(through: NDArray[np.float64], scene: Scene, centre: NDArray[np.float64]) -> float:
    """Away from the camera, so that the hand comes from where one can see; else by the first coordinate."""
    if scene.cloud.camera is not None and (score := float(through @ (centre - scene.cloud.camera))) != 0:
        return float(np.sign(score))
    first = through[np.flatnonzero(np.abs(through) > 1e-9)[0]]
    return float(np.sign(first))


def _unit(vector: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The vector at length 1, and the length it had; zeros stay zeros."""
    length = float(np.linalg.norm(vector))
    return (vector / length, length) if length > 1e-9 else (np.zeros(3), 0.0)
