"""Scenes to a wanted mix of relations: truth decides, so draw until the mix is met."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import CORE_RELATIONS, PairLabel
from lifelore.domains.tabletop.settings import TabletopScene

TOLERANCE = 0.02
"""Sum of the shares' distances to the mix below which any scene that keeps it so is welcome."""
SLACK = 6.0
"""Pairs by which the counts may be off the mix at any time: scenes bring several pairs at once."""
PATIENCE = 6
"""Scenes refused in a row before the least bad of them is taken, so that a mix out of reach costs bounded time."""


def wanted_relation(number: int, mix: Mapping[str, float]) -> str:
    """The relation of pair `number` such that the first n pairs are as near to the mix as whole numbers allow.

    Examples
    --------
    >>> [wanted_relation(i, {"on": 2, "adjacent": 1}) for i in range(6)]
    ['on', 'adjacent', 'on', 'on', 'adjacent', 'on']
    """
    shares = _shares(mix)
    counts, chosen = np.zeros(len(shares)), 0
    for n in range(number + 1):
        chosen = int(np.argmax(shares * (n + 1) - counts))
        counts[chosen] += 1
    return CORE_RELATIONS[chosen]


def to_mix(candidates: Iterable[TabletopScene], mix: Mapping[str, float]) -> Iterator[TabletopScene]:
    """Of scenes in order those that bring the mix of all pairs so far nearer to the wanted one, or hold it.

    The attempts of a scene are its own and those of the scenes refused for it.
    """
    shares, counts = _shares(mix), np.zeros(len(CORE_RELATIONS))
    refused: list[tuple[float, NDArray[np.float64], TabletopScene]] = []
    for scene in candidates:
        added = count_relations(scene.truth)
        off = _off(counts + added, shares)
        attempts = scene.attempts + sum(one.attempts for _, _, one in refused)
        if off > max(_allowed(counts + added), _off(counts, shares)):
            refused.append((off, added, scene))
            if len(refused) < PATIENCE:
                continue
            _, added, scene = min(refused, key=lambda one: one[0])
        refused = []
        counts += added
        yield replace(scene, attempts=attempts)


def is_missed(counts: ArrayLike, mix: Mapping[str, float]) -> bool:
    """Whether pairs counted by relation, in the order of `CORE_RELATIONS`, are farther off the mix than allowed.

    Examples
    --------
    >>> is_missed([53, 27, 20, 0], {"on": 53, "adjacent": 25, "both": 22})
    False
    >>> is_missed([53, 7, 0, 40], {"on": 53, "adjacent": 25, "both": 22})
    True
    """
    drawn = np.asarray(counts, np.float64)
    return _off(drawn, _shares(mix)) > _allowed(drawn)


def count_relations(truth: Sequence[PairLabel]) -> NDArray[np.float64]:
    """How many pairs of objects stand in each relation, in the order of `CORE_RELATIONS`; the table left out."""
    labels = [label.relation for label in truth if label.b != TABLE]
    return np.array([labels.count(relation) for relation in CORE_RELATIONS], dtype=float)


def _shares(mix: Mapping[str, float]) -> NDArray[np.float64]:
    shares = np.array([float(mix.get(relation, 0.0)) for relation in CORE_RELATIONS])
    return shares / shares.sum()


def _allowed(counts: NDArray[np.float64]) -> float:
    return max(TOLERANCE, SLACK / max(float(counts.sum()), 1.0))


def _off(counts: NDArray[np.float64], shares: NDArray[np.float64]) -> float:
    return float(np.abs(counts / counts.sum() - shares).sum()) if counts.sum() else 2.0
