"""What is true of a settled scene: who carries whom, from forces and from gaps; labels as a person gives them.

*on*: more than `SHARE` of a's weight comes from b through contacts whose normal lies within 45° of up. *Beside*: a
contact or near miss with a normal within 45° of horizontal between objects that overlap in height, or a visible
gap of at most `ADJACENT_GAP` between objects side by side. *both*: on and beside, or leaning: b carries part of a,
and a reaches well below the place where it does. Where forces and the view disagree (neighbours touch, but the gap
that is seen is wider than `ADJACENT_GAP`) the label is doubtful. Thesis: §2.3.2, §2.4.1: there a person labels.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, NONE, ON, PairLabel
from lifelore.domains.tabletop.physics import Contacts

NEAR = 0.08
"""Metres: pairs that do not touch and are seen further apart get no label."""
SHARE = 0.05
"""Part of its weight that an object must get from what it rests on."""
DOUBTFUL_SHARE = (0.02, 0.12)
DOUBTFUL_GAP = 0.005
PROBABLE_GAP = 0.010
"""Metres from `ADJACENT_GAP` within which a label by the gap alone is doubtful (1) or probable (2)."""
UNSEEN = 0.04
"""Metres of visible gap above which a contact is hidden from whoever looks: probable (2) at most."""
LEAN_DEPTH = 0.015
"""Metres that a leaning object reaches below the place where it is carried."""
OVERLAP = 0.015
"""Metres of height that neighbours share at least: a box's edge on a box pushes sideways, too."""
_STEEP = np.cos(np.pi / 4)


@dataclass(frozen=True)
class Gap:
    """Distance of a pair: between seen points (noise-free), between surfaces, and the way from `a` to `b`."""

    a: int
    b: int
    visible: float
    true: float
    sideways: bool


@dataclass(frozen=True, eq=False)
class Bearing:
    """How n objects bear on one another; row a, column b; column n is the table.

    `share` is the part of a's weight that b gives through contacts with a normal within 45° of up, `lift` through
    all contacts, `side` whether a contact or near miss has a normal within 45° of horizontal, `height` the lowest
    place at which b carries a (infinite where it does not), `touching` whether a contact or near miss exists.
    """

    share: NDArray[np.float64]
    lift: NDArray[np.float64]
    side: NDArray[np.bool_]
    height: NDArray[np.float64]
    touching: NDArray[np.bool_]


def bearing(contacts: Contacts, weights: NDArray[np.float64]) -> Bearing:
    """Sum contacts over pairs; `weights` (n,) in newtons."""
    first, second, normals, forces = contacts.first, contacts.second, contacts.normals, contacts.forces
    heights = contacts.positions[:, 2]
    n = len(weights)
    a = np.concatenate([second, first])
    b = np.concatenate([first, second])
    a, b = np.where(a < 0, n, a), np.where(b < 0, n, b)
    up = np.concatenate([normals[:, 2], -normals[:, 2]])
    lift = np.concatenate([forces[:, 2], -forces[:, 2]])
    height = np.concatenate([heights, heights])
    heavy = np.append(weights, np.inf)
    bears = _sums(a, b, np.where(up >= _STEEP, lift, 0.0), n + 1) / heavy[:, None]
    lowest = np.full((n + 1, n + 1), np.inf)
    np.minimum.at(lowest, (a, b), np.where(lift > 0, height, np.inf))
    side = _sums(a, b, (np.abs(up) <= _STEEP).astype(float), n + 1) > 0
    touching = _sums(a, b, np.ones(len(a)), n + 1) > 0
    return Bearing(bears, _sums(a, b, lift, n + 1) / heavy[:, None], side, lowest, touching)


def _sums(
    a: NDArray[np.int64], b: NDArray[np.int64], values: NDArray[np.float64], size: int
) -> NDArray[np.float64]:
    return np.bincount(a * size + b, values, size * size).astype(float).reshape(size, size)


def true_relations(
    borne: Bearing,
    gaps: Mapping[tuple[int, int], Gap],
    heights: NDArray[np.float64],
    labels: Sequence[int],
) -> tuple[PairLabel, ...]:
    """Labels of every near pair of objects, and of every object with the table.

    Parameters
    ----------
    borne : Bearing
    gaps : mapping
        `Gap` of each pair of numbers i < j that may be near.
    heights : (n, 2) float64
        Of each object's lowest and highest point, metres.
    labels : sequence of int
        The label of object i in the cloud.
    """
    n = len(heights)
    truth = [_with_table(borne, i, n, labels[i]) for i in range(n)]
    for (i, j), gap in sorted(gaps.items()):
        if borne.touching[i, j] or gap.visible <= NEAR:
            upper, lower = (i, j) if _carried(borne, i, j) >= _carried(borne, j, i) else (j, i)
            relation, confidence = _relation(borne, upper, lower, gap, heights)
            if relation != NONE and gap.visible > UNSEEN:
                confidence = min(confidence, 2)
            truth.append(PairLabel(labels[upper], labels[lower], relation, confidence))
    return tuple(truth)


def _with_table(borne: Bearing, i: int, table: int, label: int) -> PairLabel:
    share = float(borne.share[i, table])
    return PairLabel(label, TABLE, ON if share > SHARE else NONE, _by_share(share))


def _carried(borne: Bearing, a: int, b: int) -> float:
    return float(max(borne.share[a, b], borne.lift[a, b]))


def _relation(borne: Bearing, a: int, b: int, gap: Gap, heights: NDArray[np.float64]) -> tuple[str, int]:
    share, lift = float(borne.share[a, b]), float(borne.lift[a, b])
    overlap = min(heights[a, 1], heights[b, 1]) - max(heights[a, 0], heights[b, 0])
    side = bool(borne.side[a, b]) and overlap >= OVERLAP
    depth = float(borne.height[a, b] - heights[a, 0])
    leaning = depth > LEAN_DEPTH and SHARE < lift < 1 - SHARE
    if share > SHARE:
        beside = side or leaning
        return (BOTH if beside else ON), _by_share(share)
    if lift > SHARE and borne.side[a, b]:
        return (BOTH if side else ON), _by_share(lift)
    if side:
        return ADJACENT, _by_share(lift) if gap.visible <= ADJACENT_GAP else 1
    off = abs(gap.visible - ADJACENT_GAP)
    confidence = 1 if off < DOUBTFUL_GAP else 2 if off < PROBABLE_GAP else 3
    if gap.visible <= ADJACENT_GAP:
        return (ADJACENT, confidence) if gap.sideways else (NONE, 2)
    hidden = gap.true <= ADJACENT_GAP and gap.sideways
    return NONE, 1 if hidden else confidence


def _by_share(share: float) -> int:
    low, high = DOUBTFUL_SHARE
    return 2 if low < share < high else 3
