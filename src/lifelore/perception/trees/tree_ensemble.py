"""`TreeEnsemble`: decision trees as flat arrays that NumPy alone can predict with; scikit-learn trains them.

A model is a few arrays without pickle, and a command starts without importing scikit-learn (more than a second).
For the 4 to 20 rows of an ordinary scene, 200 trees take 1 to 5 ms; scikit-learn's forest takes 16 ms.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError

LEAF = -1
MOST_TREES, MOST_STEPS = 10_000, 1000
"""Largest number of trees, and of steps from root to leaf, in a file: they bound the time of a prediction."""
CHUNK = 4096
"""Rows per prediction step; the memory is CHUNK × trees × classes numbers."""


@dataclass(frozen=True, eq=False)
class TreeEnsemble:
    """Trees laid end to end; a leaf points to itself.

    Parameters
    ----------
    roots : (n_trees,) int32
        Node at which each tree begins.
    feature : (n_nodes,) int16
        Column that a node compares, `LEAF` at a leaf.
    threshold : (n_nodes,) float32
        Rows with ``x <= threshold`` go left.
    left, right : (n_nodes,) int32
    leaf : (n_nodes,) int32
        Row of `shares` of a leaf; 0 at inner nodes.
    shares : (n_leaf_answers, n_classes) float32
        Each row sums to 1; equal rows are stored once.
    n_features : int
    depth : int
        Steps that lead from any root to a leaf.
    """

    roots: NDArray[np.int32]
    feature: NDArray[np.int16]
    threshold: NDArray[np.float32]
    left: NDArray[np.int32]
    right: NDArray[np.int32]
    leaf: NDArray[np.int32]
    shares: NDArray[np.float32]
    n_features: int
    depth: int

    @classmethod
    def from_forest(cls, forest: Any) -> "TreeEnsemble":
        """From a fitted scikit-learn forest of classifiers with one output."""
        trees = [member.tree_ for member in forest.estimators_]
        roots = np.cumsum([0, *[tree.node_count for tree in trees]])[:-1]
        feature = np.concatenate([tree.feature for tree in trees])
        at_leaf = feature < 0
        own = np.arange(len(feature))
        left = np.concatenate([tree.children_left + root for tree, root in zip(trees, roots, strict=True)])
        right = np.concatenate([tree.children_right + root for tree, root in zip(trees, roots, strict=True)])
        counts = np.concatenate([tree.value[:, 0, :] for tree in trees])[at_leaf]
        answers = (counts / counts.sum(axis=1, keepdims=True)).astype(np.float32)
        shares, which = np.unique(answers, axis=0, return_inverse=True)
        leaf = np.zeros(len(feature), np.int32)
        leaf[at_leaf] = which.ravel()
        return cls(
            roots=roots.astype(np.int32),
            feature=np.where(at_leaf, LEAF, feature).astype(np.int16),
            threshold=_rounded_down(np.concatenate([tree.threshold for tree in trees]), at_leaf),
            left=np.where(at_leaf, own, left).astype(np.int32),
            right=np.where(at_leaf, own, right).astype(np.int32),
            leaf=leaf,
            shares=shares,
            n_features=int(forest.n_features_in_),
            depth=max(int(tree.max_depth) for tree in trees),
        )

    @property
    def n_classes(self) -> int:
        """Number of classes."""
        return self.shares.shape[1]

    def predict_proba(self, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Mean share over the trees, ``(n, n_classes)``, rows sum to 1.

        Parameters
        ----------
        rows : (n, n_features)
            Compared in single precision, as in training.
        """
        single = np.ascontiguousarray(rows, np.float32)
        parts = [self._answers(single[at : at + CHUNK]) for at in range(0, len(single), CHUNK)]
        return np.concatenate(parts) if parts else np.empty((0, self.n_classes))

    def _answers(self, rows: NDArray[np.float32]) -> NDArray[np.float64]:
        row = np.arange(len(rows))[:, None]
        node = np.broadcast_to(self.roots, (len(rows), len(self.roots)))
        for _ in range(self.depth):
            goes_left = rows[row, self.feature[node]] <= self.threshold[node]
            node = np.where(goes_left, self.left[node], self.right[node])
        return self.shares[self.leaf[node]].mean(axis=1, dtype=np.float64)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything as arrays, by name."""
        return {name: np.asarray(value) for name, value in vars(self).items()}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "TreeEnsemble":
        """From the result of `arrays`.

        Raises
        ------
        InputError
            An array is missing, or the numbers cannot be trees.
        """
        missing = [name for name in cls.__dataclass_fields__ if name not in arrays]
        if missing:
            raise InputError(f"trees must have {', '.join(missing)}, which the model lacks; train it anew")
        fields = {name: arrays[name] for name in cls.__dataclass_fields__}
        kinds = {"threshold": "f", "shares": "f"}
        sizes = {"shares": 2, "n_features": 0, "depth": 0}
        if odd := [
            name
            for name, array in fields.items()
            if array.dtype.kind != kinds.get(name, "i") or array.ndim != sizes.get(name, 1) or not array.size
        ]:
            raise InputError(f"the model's trees are damaged: {', '.join(odd)} hold something else; train it anew")
        found = cls(**{**fields, "n_features": int(fields["n_features"]), "depth": int(fields["depth"])})
        found._check()
        return found

    def _check(self) -> None:
        if not self._points_inside():
            raise InputError("the model's trees are damaged: they point outside themselves; train it anew")
        if not (np.isfinite(self.threshold).all() and _are_shares(self.shares)):
            raise InputError("the model's trees are damaged: numbers are no thresholds or shares; train it anew")
        if len(self.roots) > MOST_TREES or not 0 <= self.depth <= MOST_STEPS:
            raise InputError(
                f"the model's trees are damaged: {len(self.roots)} trees of {self.depth} steps, of at most"
                f" {MOST_TREES} and {MOST_STEPS}; train it anew"
            )
        if not self._ends():
            raise InputError("the model's trees are damaged: not every way ends in a leaf; train it anew")

    def _points_inside(self) -> bool:
        n = len(self.feature)
        inside = (
            (self.roots, 0, n),
            (self.left, 0, n),
            (self.right, 0, n),
            (self.leaf, 0, len(self.shares)),
            (self.feature, LEAF, self.n_features),
        )
        same_length = all(len(column) == n for column in (self.threshold, self.left, self.right, self.leaf))
        return same_length and all(a.min() >= low and a.max() < high for a, low, high in inside)

    def _ends(self) -> bool:
        """Whether every way from a root comes to a leaf in `depth` steps and stays there, and no two ways meet."""
        own, at_leaf = np.arange(len(self.feature)), self.feature == LEAF
        if ((self.left != own) | (self.right != own))[at_leaf].any():
            return False
        reached, seen = self.roots, len(self.roots)
        for _ in range(self.depth):
            inner = reached[~at_leaf[reached]]
            reached = np.concatenate([self.left[inner], self.right[inner]])
            seen += len(reached)
            if not len(reached) or seen > len(own):
                break
        return seen <= len(own) and bool(at_leaf[reached].all())


def _are_shares(shares: NDArray[np.float32]) -> bool:
    return bool(np.isfinite(shares).all() and (shares >= 0).all() and (abs(shares.sum(axis=1) - 1) < 1e-3).all())


def _rounded_down(threshold: NDArray[np.float64], at_leaf: NDArray[np.bool_]) -> NDArray[np.float32]:
    """The largest single-precision numbers at most `threshold`: they part single-precision rows the same way."""
    single = threshold.astype(np.float32)
    above = single.astype(np.float64) > threshold
    return np.where(at_leaf, 0, np.where(above, np.nextafter(single, np.float32(-np.inf)), single)).astype(
        np.float32
    )
