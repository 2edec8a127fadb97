"""The floor under every number: the most frequent relation, whatever the scene shows."""

from collections import Counter
from collections.abc import Sequence
from typing import Self

from lifelore.core.errors import InputError
from lifelore.core.relations import SYMMETRIC, PairLabel
from lifelore.perception.pairs.directed_label import REVERSED
from lifelore.perception.peers.centroid_neighbours import centroid_displacement
from lifelore.perception.peers.peer import Peer, SeenPair, labelled
from lifelore.perception.relations.relation import Relation


class Majority(Peer):
    """Says the most frequent relation of every near pair, among objects and with the table apart.

    Where the relation has a direction, the object whose centroid is higher comes first: a coin would halve the
    number that a majority is quoted for.
    """

    describe = staticmethod(centroid_displacement)

    def __init__(self) -> None:
        self._most: dict[bool, tuple[str, float]] = {}

    def fit_pairs(self, scenes: Sequence[Sequence[SeenPair]], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """Count what is said of near pairs."""
        said: dict[bool, Counter[str]] = {False: Counter(), True: Counter()}
        for pair, name in labelled(scenes, truths):
            said[pair.with_table][name.removeprefix(REVERSED)] += 1
        for kind, count in said.items():
            if count:
                name = max(sorted(count), key=count.__getitem__)
                self._most[kind] = name, count[name] / count.total()
        return self

    def predict_pairs(self, scene: Sequence[SeenPair]) -> tuple[Relation, ...]:
        """One relation for every near pair, its share of the training labels as confidence."""
        if not self._most:
            raise InputError("a classifier must be fitted before it is asked; call fit first")
        return tuple(_said(pair, *self._most[pair.with_table]) for pair in scene if pair.with_table in self._most)


def _said(pair: SeenPair, name: str, share: float) -> Relation:
    upright = pair.with_table or name in SYMMETRIC or pair.rows[0, 2] >= 0
    return pair.relation(name if upright else REVERSED + name, share)
