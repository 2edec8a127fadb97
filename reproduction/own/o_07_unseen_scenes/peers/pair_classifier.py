"""`PairClassifier`: a peer with a scikit-learn estimator, mirrored rows, and separate models for pairs with the
table.

Every labelled pair is a training row in both orders, so that no method can learn which object a file names first.
A prediction adds the shares of both orders.
"""

from collections.abc import Callable, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.relations import SYMMETRIC, PairLabel
from lifelore.perception.pairs.directed_label import mirrored
from lifelore.perception.relations.relation import Relation
from reproduction.own.o_07_unseen_scenes.peers.peer import Describe, DescribedPair, Peer, labelled_pairs


class PairClassifier(Peer):
    """Learns relations from descriptions of pairs.

    Parameters
    ----------
    describe : callable
    estimator : callable
        Makes a fresh scikit-learn classifier with ``predict_proba``.
    """

    def __init__(self, describe: Describe, estimator: Callable[[], Any]) -> None:
        self.describe = describe
        self._new_estimator = estimator
        self._estimators: dict[bool, Any] = {}

    def fit_pairs(self, scenes: Sequence[Sequence[DescribedPair]], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """As `fit`, from scenes already described by `describe_pairs`."""
        rows: dict[bool, list[NDArray]] = {False: [], True: []}
        names: dict[bool, list[str]] = {False: [], True: []}
        for pair, name in labelled_pairs(scenes, truths):
            rows[pair.with_table] += list(pair.rows)
            names[pair.with_table] += [name, mirrored(name, SYMMETRIC)]
        self._estimators = {kind: self._fitted(rows[kind], names[kind]) for kind in rows if rows[kind]}
        return self

    def predict_pairs(self, scene: Sequence[DescribedPair]) -> tuple[Relation, ...]:
        """As `predict`, from a scene already described by `describe_pairs`."""
        if not self._estimators:
            raise InputError("a classifier must be fitted before it predicts; call fit first")
        judged: dict[int, Relation] = {}
        for kind, model in self._estimators.items():
            places = [at for at, pair in enumerate(scene) if pair.with_table == kind]
            if places:
                shares = model.predict_proba(np.concatenate([scene[at].rows for at in places]))
                for at, both in zip(places, shares.reshape(len(places), 2, -1), strict=True):
                    judged[at] = _judged(scene[at], model.classes_.tolist(), both)
        return tuple(judged[at] for at in sorted(judged))

    def _fitted(self, rows: list[NDArray], names: list[str]) -> Any:
        from sklearn.dummy import DummyClassifier

        model = self._new_estimator() if len(set(names)) > 1 else DummyClassifier()
        return model.fit(np.array(rows), np.array(names))


def _judged(pair: DescribedPair, classes: list[str], both: NDArray[np.float64]) -> Relation:
    """The class with the largest share, summed over both orders of the pair."""
    votes: dict[str, float] = {}
    for name, forward, backward in zip(classes, *both, strict=True):
        turned = mirrored(name, SYMMETRIC)
        votes[name] = votes.get(name, 0.0) + forward / 2
        votes[turned] = votes.get(turned, 0.0) + backward / 2
    best = max(sorted(votes), key=votes.__getitem__)
    return pair.relation(best, float(votes[best]))
