"""`Peer`: the interface of `RelationClassifier` for a method that describes each pair by numbers.

Looking and learning are apart: a scene is looked at once, and any number of models learn from what was seen.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import SYMMETRIC, PairLabel
from lifelore.perception.pairs.directed_label import REVERSED
from lifelore.perception.pairs.pair_class import LEAST_CONFIDENCE, pair_class
from lifelore.perception.peers.seen_pairs import seen_pairs
from lifelore.perception.relations.relation import Relation

Describe = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]
"""Two clouds of points, (n, 3) and (m, 3), to a vector; always of the same length."""


@dataclass(frozen=True, eq=False)
class SeenPair:
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
        """The relation of a directed class of this pair: turned round where the name says so."""
        if name.startswith(REVERSED):
            return Relation(self.b, self.a, name.removeprefix(REVERSED), confidence, self.gap)
        return Relation(self.a, self.b, name, confidence, self.gap)


class Peer(ABC):
    """A method that sees each pair as the vector that `describe` makes of it."""

    describe: Describe

    @abstractmethod
    def fit_pairs(self, scenes: Sequence[Sequence[SeenPair]], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """As `fit`, from scenes that were looked at before."""

    @abstractmethod
    def predict_pairs(self, scene: Sequence[SeenPair]) -> tuple[Relation, ...]:
        """As `predict`, from a scene that was looked at before."""

    def look(self, cloud: LabelledCloud) -> tuple[SeenPair, ...]:
        """The near pairs of a scene as this method sees them; objects first, then each object with the table."""
        seen = []
        for pair in seen_pairs(cloud):
            first, second = pair.first.points, pair.second.points
            rows = np.array([self.describe(first, second), self.describe(second, first)])
            seen.append(SeenPair(pair.first.label, pair.second.label, pair.gap, rows))
        return tuple(seen)

    def fit(self, clouds: Sequence[LabelledCloud], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """Learn from scenes and what is said of their pairs with confidence 2 or more.

        Raises
        ------
        InputError
            `clouds` and `truths` differ in number, no label is of a near pair, or one pair has two relations (or
            one in both directions that is not *adjacent* or *none*, all that a peer knows to be symmetric).
        """
        return self.fit_pairs([self.look(cloud) for cloud in clouds], truths)

    def predict(self, cloud: LabelledCloud) -> tuple[Relation, ...]:
        """The relation of every near pair, *none* included, of a kind (among objects, with the table) it knows.

        Raises
        ------
        InputError
            A method that learns has not been fitted.
        """
        return self.predict_pairs(self.look(cloud))


def labelled(
    scenes: Sequence[Sequence[SeenPair]], truths: Sequence[Sequence[PairLabel]]
) -> list[tuple[SeenPair, str]]:
    """Near pairs of which something is said, and the directed class that is said of (a, b)."""
    if len(scenes) != len(truths):
        raise InputError(f"truths must be one for each cloud, got {len(truths)} for {len(scenes)} clouds")
    found = []
    for pairs, truth in zip(scenes, truths, strict=True):
        said: dict[frozenset[int], list[PairLabel]] = {}
        for label in truth:
            if label.confidence >= LEAST_CONFIDENCE:
                said.setdefault(frozenset((label.a, label.b)), []).append(label)
        for pair in pairs:
            if labels := said.get(frozenset((pair.a, pair.b))):
                found.append((pair, pair_class(labels, pair.a, SYMMETRIC)))
    if not found:
        raise InputError("truths must label a near pair of clouds with confidence 2 or 3; check their numbers")
    return found
