"""Stability of contact point networks when points are discarded."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.relations import NONE, PairLabel
from lifelore.perception.contacts.interface import Interface

Nodes = dict[tuple[int, int], NDArray[np.float64]]
"""(object, other) → positions of its contact points towards the other, (k, 3)."""


@dataclass(frozen=True, eq=False)
class Stability:
    """Of each network towards one other object: whether it has as many nodes; and how far nodes moved, metres."""

    same_count: tuple[bool, ...]
    shifts: tuple[float, ...]


def contact_nodes(found: Sequence[Interface], truth: Sequence[PairLabel]) -> Nodes:
    """Contact points of every pair that bears a relation."""
    near = {frozenset((label.a, label.b)) for label in truth if label.relation != NONE and label.confidence >= 2}
    nodes: Nodes = {}
    for pair in found:
        if frozenset((pair.a, pair.b)) in near:
            nodes[pair.a, pair.b] = np.array([contact.position for contact in pair.contacts_a])
            nodes[pair.b, pair.a] = np.array([contact.position for contact in pair.contacts_b])
    return nodes


def stability(before: Nodes, after: Nodes) -> Stability:
    """Each network of `before` beside that of `after`; nodes are matched to the nearest where as many are left."""
    same, shifts = [], []
    for key, nodes in before.items():
        others = after.get(key, np.empty((0, 3)))
        same.append(len(nodes) == len(others))
        if same[-1]:
            shifts += np.linalg.norm(nodes[:, None] - others[None], axis=-1).min(axis=1).tolist()
    return Stability(tuple(same), tuple(shifts))
