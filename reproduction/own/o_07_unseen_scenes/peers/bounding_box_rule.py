"""A rule on axis-aligned boxes, as many systems ship it: nothing is learned."""

from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, NONE, ON, PairLabel
from lifelore.perception.pairs.directed_label import REVERSED
from lifelore.perception.relations.relation import Relation
from reproduction.own.o_07_unseen_scenes.peers.described_pairs import DescribedPair

TOLERANCE = 0.02
"""Metres by which an object may start below the top of its support, or above the table."""
OVERLAP = 0.15
"""Least share of the smaller ground plan inside the other for one object to be above the other."""


def boxes(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Bottom and top of either, metres, and the share of the smaller ground plan in common; shape ``(5,)``.

    Heights from the 1st to the 99th percentile.
    """
    heights = [np.quantile(points[:, 2], [0.01, 0.99]) for points in (first, second)]
    low = np.array([points[:, :2].min(axis=0) for points in (first, second)])
    high = np.array([points[:, :2].max(axis=0) for points in (first, second)])
    common = np.maximum(high.min(axis=0) - low.max(axis=0), 0).prod()
    return np.array([*heights[0], *heights[1], common / max((high - low).prod(axis=1).min(), 1e-12)])


class BoundingBoxRule:
    """Relations read off axis-aligned boxes.

    The boxes' ground plans overlap, and one starts no lower than `TOLERANCE` under the top of the other: on. They
    overlap without that, and one hangs higher than `TOLERANCE` over the table: both. Otherwise adjacent up to
    `ADJACENT_GAP`, else none. On the table: starts within `TOLERANCE` of it.
    """

    describe = staticmethod(boxes)

    def fit(self, scenes: Sequence[Sequence[DescribedPair]], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """Nothing is learnt."""
        return self

    def predict(self, scene: Sequence[DescribedPair]) -> tuple[Relation, ...]:
        """The relation of every near pair, each with confidence 1."""
        return tuple(pair.relation(_name(pair), 1.0) for pair in scene)


def _name(pair: DescribedPair) -> str:
    bottom, top, other_bottom, other_top, overlap = pair.rows[0].tolist()
    if pair.with_table:
        return ON if bottom <= TOLERANCE else NONE
    if overlap >= OVERLAP:
        if bottom >= other_top - TOLERANCE:
            return ON
        if other_bottom >= top - TOLERANCE:
            return REVERSED + ON
        if max(bottom, other_bottom) > TOLERANCE:
            return BOTH if bottom > other_bottom else REVERSED + BOTH
    return ADJACENT if pair.gap <= ADJACENT_GAP else NONE
