"""Majority baseline: always predicts the most frequent relation."""

from collections import Counter
from collections.abc import Sequence
from typing import Self

from lifelore.core.errors import InputError
from lifelore.core.relations import SYMMETRIC, PairLabel
from lifelore.perception.pairs.directed_label import REVERSED
from lifelore.perception.peers.centroid_neighbours import centroid_displacement
from lifelore.perception.peers.peer import DescribedPair, Peer, labelled_pairs
from lifelore.perception.relations.relation import Relation


class Majority(Peer):
    """Predicts the most frequent relation for every near pair, separately among objects and with the table.

    Where the relation has a direction, the object whose centroid is higher comes first: a random order
    would halve the share of right answers.
    """

    describe = staticmethod(centroid_displacement)

    def __init__(self) -> None:
        self._most: dict[bool, tuple[str, float]] = {}

    def fit_pairs(self, scenes: Sequence[Sequence[DescribedPair]], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """Count the labels of near pairs."""
        counts: dict[bool, Counter[str]] = {False: Counter(), True: Counter()}
        for pair, name in labelled_pairs(scenes, truths):
            counts[pair.with_table][name.removeprefix(REVERSED)] += 1
        for kind, count in counts.items():
            if count:
                name = max(sorted(count), key=count.__getitem__)
                self._most[kind] = name, count[name] / count.total()
        return self

    def predict_pairs(self, scene: Sequence[DescribedPair]) -> tuple[Relation, ...]:
        """One relation for every near pair, its share of the training labels as confidence."""
        if not self._most:
            raise InputError("a classifier must be fitted before it predicts; call fit first")
        return tuple(
            _relation(pair, *self._most[pair.with_table]) for pair in scene if pair.with_table in self._most
        )


def _relation(pair: DescribedPair, name: str, share: float) -> Relation:
    upright = pair.with_table or name in SYMMETRIC or pair.rows[0, 2] >= 0
    return pair.relation(name if upright else REVERSED + name, share)
