"""Near pairs of a scene described by vectors, for methods that learn relations from them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import SYMMETRIC, PairLabel
from lifelore.perception.clouds.voxel import voxelised, voxels_of
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.near_pairs import NearPair, near_pairs, split_objects
from lifelore.perception.pairs.directed_label import LEAST_CONFIDENCE, REVERSED, pair_class
from lifelore.perception.relations.relation import Relation

SETTINGS = ContactSettings()
"""The contact settings of every peer."""
Describe = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]
"""Two clouds of points, (n, 3) and (m, 3), to a vector; always of the same length."""


@dataclass(frozen=True, eq=False)
class DescribedPair:
    """A near pair without its points.

    Parameters
    ----------
    a, b : int
        a < b among objects; b is the table in a pair with it.
    gap : float
        Visible gap, metres.
    rows : (2, d) float64
        The description of (a, b) and of (b, a).
    """

    a: int
    b: int
    gap: float
    rows: NDArray[np.float64]

    @property
    def with_table(self) -> bool:
        """Whether the second is the table."""
        return self.b == TABLE

    def relation(self, name: str, confidence: float) -> Relation:
        """The relation of a directed class of this pair, in the order that the name states."""
        if name.startswith(REVERSED):
            return Relation(self.b, self.a, name.removeprefix(REVERSED), confidence, self.gap)
        return Relation(self.a, self.b, name, confidence, self.gap)


def described_pairs(cloud: LabelledCloud, describe: Describe) -> tuple[DescribedPair, ...]:
    """The near pairs of a scene, described; pairs of objects first, then each object with the table."""
    seen = []
    for pair in default_near_pairs(cloud):
        first, second = pair.first.points, pair.second.points
        rows = np.array([describe(first, second), describe(second, first)])
        seen.append(DescribedPair(pair.first.label, pair.second.label, pair.gap, rows))
    return tuple(seen)


def labelled_pairs(
    scenes: Sequence[Sequence[DescribedPair]], truths: Sequence[Sequence[PairLabel]]
) -> Iterator[tuple[DescribedPair, str]]:
    """Near pairs with a label of confidence 2 or more, and the directed class of (a, b)."""
    for pairs, truth in zip(scenes, truths, strict=True):
        by_pair: dict[frozenset[int], list[PairLabel]] = {}
        for label in truth:
            if label.confidence >= LEAST_CONFIDENCE:
                by_pair.setdefault(frozenset((label.a, label.b)), []).append(label)
        for pair in pairs:
            if labels := by_pair.get(frozenset((pair.a, pair.b))):
                yield pair, pair_class(labels, pair.a, SYMMETRIC)


# Peers process one scene after another: a small cache finds the near pairs once for all of them.
@lru_cache(maxsize=8)
def default_near_pairs(cloud: LabelledCloud) -> tuple[NearPair, ...]:
    """Near pairs of a scene at the default settings: among objects, then each object with the table."""
    if not cloud.objects:
        return ()
    objects = split_objects(voxelised(cloud, SETTINGS.voxel))
    return tuple(near_pairs(objects, SETTINGS.near, SETTINGS.table_margin))


def mean_of_voxels(points: NDArray[np.float64], grain: float) -> NDArray[np.float64]:
    """The mean of the points in each cube of side `grain` metres, shape ``(k, 3)``."""
    return voxels_of(points, grain).means
