"""Histograms over all pairs of points in the style of Fichtl et al. (ICRA 2014), read by randomised trees.

For every point of one object and every point of the other: the elevation of their displacement over the
horizontal, and its length; counted in two dimensions. Heading is left out, so a turned table changes nothing.
"""

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.core.relations import SYMMETRIC, PairLabel
from lifelore.perception.pairs.directed_label import mirrored
from lifelore.perception.relations.relation import Relation
from reproduction.own.o_07_unseen_scenes.peers.described_pairs import (
    DescribedPair,
    labelled_pairs,
    mean_of_voxels,
)

GRAIN = 0.015
"""Side of the voxels in metres; clouds are thinned first, since all pairs of points are counted."""
ELEVATION_BINS = 12
DISTANCE_EDGES = np.array([0.0, 0.02, 0.04, 0.07, 0.11, 0.16, 0.23, 0.32, np.inf])
"""Metres, finer where objects meet."""
TREES = 100


def orientation_histogram(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shares of point pairs by elevation and distance, flat ``(ELEVATION_BINS * 8,)``, sums to 1."""
    offset = mean_of_voxels(first, GRAIN)[:, None] - mean_of_voxels(second, GRAIN)[None]
    distance = np.linalg.norm(offset, axis=-1).ravel()
    elevation = np.arcsin(np.clip(offset[..., 2].ravel() / np.maximum(distance, 1e-12), -1, 1))
    row = np.clip(((elevation / np.pi + 0.5) * ELEVATION_BINS).astype(np.int64), 0, ELEVATION_BINS - 1)
    column = np.searchsorted(DISTANCE_EDGES, distance, side="right") - 1
    bins = len(DISTANCE_EDGES) - 1
    count = np.bincount(row * bins + column, minlength=ELEVATION_BINS * bins)
    return count / count.sum()


class OrientationTrees:
    """Randomised trees on the histogram, separate ones for pairs with the table.

    Every labelled pair is a training row in both orders, so that the trees cannot learn which object a file names
    first. A prediction adds the shares of both orders.
    """

    describe = staticmethod(orientation_histogram)

    def __init__(self) -> None:
        self._trees: dict[bool, Any] = {}

    def fit(self, scenes: Sequence[Sequence[DescribedPair]], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """Learn from described scenes and the labels of their pairs."""
        from sklearn.ensemble import ExtraTreesClassifier

        rows: dict[bool, list[NDArray]] = {False: [], True: []}
        names: dict[bool, list[str]] = {False: [], True: []}
        for pair, name in labelled_pairs(scenes, truths):
            rows[pair.with_table] += list(pair.rows)
            names[pair.with_table] += [name, mirrored(name, SYMMETRIC)]
        self._trees = {
            kind: ExtraTreesClassifier(TREES, random_state=0).fit(np.array(own), np.array(names[kind]))
            for kind, own in rows.items()
            if own
        }
        return self

    def predict(self, scene: Sequence[DescribedPair]) -> tuple[Relation, ...]:
        """The relation of every near pair of a kind (among objects, with the table) that was learnt."""
        judged: dict[int, Relation] = {}
        for kind, model in self._trees.items():
            places = [at for at, pair in enumerate(scene) if pair.with_table == kind]
            if places:
                shares = model.predict_proba(np.concatenate([scene[at].rows for at in places]))
                for at, both in zip(places, shares.reshape(len(places), 2, -1), strict=True):
                    judged[at] = _judged(scene[at], model.classes_.tolist(), both)
        return tuple(judged[at] for at in sorted(judged))


def _judged(pair: DescribedPair, classes: list[str], both: NDArray[np.float64]) -> Relation:
    """The class with the largest share, summed over both orders of the pair."""
    votes: dict[str, float] = {}
    for name, forward, backward in zip(classes, *both, strict=True):
        turned = mirrored(name, SYMMETRIC)
        votes[name] = votes.get(name, 0.0) + forward / 2
        votes[turned] = votes.get(turned, 0.0) + backward / 2
    best = max(sorted(votes), key=votes.__getitem__)
    return pair.relation(best, float(votes[best]))
