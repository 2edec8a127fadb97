"""Functional similarity: how alike two objects are *used*, by the topology of their contact point networks.

An object's role is written down as a bag of tokens, from its own network outwards to the neighbours of its
neighbours: how many contact points, which way each faces (carried from below, carrying above, beside), what kinds
of contact the network's edges join, and the kinds of contact met on walks of one and two steps over contact edges,
by object or table. These are Weisfeiler–Lehman refinements cut open into walks, so that roles that differ in one
contact still share most tokens. Neighbours related by *none* take no part; nor do the size, shape, colour and
number of objects. Two roles are as similar as their bags overlap: Σ min / Σ max over tokens.

The peer looks at shape alone: the D2 distribution (distances of random pairs of points), in units of its mean.

Thesis: §5.2: "functional similarity between different objects", to "classify objects based on the way in which
they are used in a scene".
"""

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.contacts.contact_points import ContactPoint
from lifelore.perception.scene import Scene

STEEP = np.sqrt(0.5)
"""A contact faces up or down if its normal is within 45° of the vertical."""

DISTANCES, BINS, FARTHEST = 20_000, 64, 3.0


def overlap(first: Counter, second: Counter) -> float:
    """Σ min / Σ max of two bags, 1 for two empty ones."""
    together = (first | second).total()
    return (first & second).total() / together if together else 1.0


def role(scene: Scene, label: int) -> Counter:
    """The tokens that describe how an object is used; see the head of this module."""
    scene = scene.without_unrelated_contacts
    network = scene.networks[label]
    facing = [_facing(node) for node in network.nodes]
    tokens: Counter = Counter({("points", len(facing)): 1})
    tokens.update(("contact", way, _kind(node.other)) for way, node in zip(facing, network.nodes, strict=True))
    tokens.update(("edge", *sorted((facing[i], facing[j]))) for i, j in network.edges.tolist())
    for way, other in _neighbours(scene, label):
        tokens["step", way, _kind(other)] += 1
        beyond = (step for step in _neighbours(scene, other) if other != TABLE and step[1] != label)
        tokens.update(("steps", way, _kind(other), far, _kind(third)) for far, third in beyond)
    return tokens


def shape_distribution(points: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Distances of random pairs in units of their mean, a histogram ``(BINS,)``, sums to 1 (Osada et al. 2002)."""
    pairs = rng.integers(0, len(points), (2, DISTANCES))
    apart = np.linalg.norm(points[pairs[0]] - points[pairs[1]], axis=1)
    counts = np.histogram(np.minimum(apart / apart.mean(), FARTHEST), BINS, (0, FARTHEST))[0]
    return counts / counts.sum()


def _facing(node: ContactPoint) -> str:
    """Where the other object is: a contact's normal points into the object it belongs to."""
    if node.normal[2] > STEEP:
        return "below"
    return "above" if node.normal[2] < -STEEP else "beside"


def _kind(label: int) -> str:
    return "table" if label == TABLE else "object"


def _neighbours(scene: Scene, label: int) -> list[tuple[str, int]]:
    """The objects that an object touches, each with the way its strongest contact faces; ascending."""
    strongest: dict[int, ContactPoint] = {}
    for node in scene.networks[label].nodes:
        known = strongest.get(node.other)
        if known is None or node.strength > known.strength:
            strongest[node.other] = node
    return [(_facing(strongest[other]), other) for other in sorted(strongest)]
