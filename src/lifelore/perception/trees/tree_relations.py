"""Relations of pairs by trees on pair features: direction inferred, adjacency by the gap, the table last.

Pairs of objects are predicted first, as the mean over both orders. Then each object's pair with the table is
predicted with one more set of features: the probability that another object supports it. An object's foot is often
hidden, so "on the table unless on another object" is better than any measurement at the foot.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.pairs import gap_rule
from lifelore.perception.pairs.directed_label import directed_classes, mirror_order
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.trees.tree_ensemble import TreeEnsemble

CARRIED = "most_"
"""Prefix of features: the greatest share of a class over an object's pairs with other objects."""
Shares = dict[str, NDArray[np.float64]]


@dataclass(frozen=True)
class Vocabulary:
    """The learned names, the symmetric names, and the gap between *adjacent* and *none*.

    `adjacent_gap` is None where the gap rule does not apply.
    """

    names: tuple[str, ...]
    symmetric: frozenset[str]
    adjacent_gap: float | None


@dataclass(frozen=True, eq=False)
class TreeRelations:
    """Trees over some columns of the pair features, and their classes.

    Parameters
    ----------
    classes : tuple of str
        Sorted; ``~`` marks the other order.
    columns : tuple of str
        Features, in the trees' order.
    trees : TreeEnsemble
    temperature : float
        Shares are raised to its inverse and normalised, which calibrates them.
    """

    classes: tuple[str, ...]
    columns: tuple[str, ...]
    trees: TreeEnsemble
    temperature: float = 1.0

    def shares(self, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Calibrated shares of rows ``(n, d)``, ``(n, n_classes)``."""
        return apply_temperature(self.trees.predict_proba(rows), self.temperature)


def apply_temperature(shares: NDArray[np.float64], temperature: float) -> NDArray[np.float64]:
    """Rows raised to 1 / temperature and made to sum to 1 again."""
    if temperature == 1.0:
        return shares
    raised = shares ** (1.0 / temperature)
    return raised / raised.sum(axis=1, keepdims=True)


def mean_of_both_orders(
    model: TreeRelations, rows: NDArray[np.float64], symmetric: frozenset[str]
) -> NDArray[np.float64]:
    """Shares of pairs from rows in both orders ``(2n, d)``, ``(n, n_classes)`` of the first order."""
    shares = model.trees.predict_proba(rows)
    order = mirror_order(model.classes, symmetric)
    return apply_temperature((shares[::2] + shares[1::2][:, order]) / 2, model.temperature)


def inner_symmetric(symmetric: frozenset[str]) -> frozenset[str]:
    """The symmetric names and the gap rule's `BESIDE`."""
    return symmetric | {gap_rule.BESIDE}


def object_shares(
    model: TreeRelations, scene: ScenePairs, symmetric: frozenset[str], adjacent_gap: float | None
) -> Shares:
    """Shares of every class for the pairs among objects, by name, each ``(n_object_pairs,)``."""
    rows = np.repeat(~scene.with_table, 2)
    found = mean_of_both_orders(model, scene.features.columns(model.columns)[rows], inner_symmetric(symmetric))
    shares = dict(zip(model.classes, found.T, strict=True))
    if gap_rule.BESIDE not in shares:
        return shares
    if adjacent_gap is None:
        raise InputError("adjacent_gap must be metres for a model that learnt with one, got None; train it again")
    return gap_rule.resolve_beside(shares, scene.features.gaps[::2][~scene.with_table], adjacent_gap)


def carried_columns(vocabulary: Sequence[str], symmetric: frozenset[str]) -> tuple[str, ...]:
    """Names of the features of a table row that describe its object's other pairs."""
    return tuple(f"{CARRIED}{name}" for name in directed_classes(vocabulary, symmetric))


def table_rows(
    scene: ScenePairs, shares: Shares, vocabulary: Sequence[str], symmetric: frozenset[str], columns: Sequence[str]
) -> NDArray[np.float64]:
    """A row for each pair with the table, in the order (object, table).

    Its own features, then the greatest share of each class over the object's pairs with other objects.
    """
    at = scene.with_table
    own = scene.features.columns(columns)[::2][at]
    objects = scene.features.pairs[::2][at][:, 0]
    pairs = scene.features.pairs[::2][~at]
    names = directed_classes(vocabulary, symmetric)
    order = mirror_order(names, symmetric)
    forward = np.stack([shares.get(name, np.zeros(len(pairs))) for name in names], axis=1)
    most = np.zeros((len(objects), len(names)))
    for side, seen in ((0, forward), (1, forward[:, order])):
        for row, number in enumerate(objects):
            mine = seen[pairs[:, side] == number]
            if len(mine):
                most[row] = np.maximum(most[row], mine.max(axis=0))
    return np.hstack([own, most])


def tree_shares(
    objects: TreeRelations | None, table: TreeRelations | None, scene: ScenePairs, vocabulary: Vocabulary
) -> list[dict[str, float]]:
    """Shares of every pair of a scene by name, in the scene's order; empty where no model covers its kind."""
    found: list[dict[str, float]] = [{} for _ in scene.with_table]
    among: Shares = {}
    if objects is not None:
        among = object_shares(objects, scene, vocabulary.symmetric, vocabulary.adjacent_gap)
        _fill(found, np.flatnonzero(~scene.with_table), among)
    if table is not None:
        own = [name for name in table.columns if not name.startswith(CARRIED)]
        rows = table_rows(scene, among, vocabulary.names, vocabulary.symmetric, own)
        _fill(found, np.flatnonzero(scene.with_table), dict(zip(table.classes, table.shares(rows).T, strict=True)))
    return found


def _fill(found: list[dict[str, float]], places: NDArray[np.int64], shares: Shares) -> None:
    for row, place in enumerate(places):
        found[place] = {name: float(column[row]) for name, column in shares.items()}
