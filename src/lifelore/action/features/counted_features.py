"""Counts of useful actions by features, and the entropy of the action set under a set of features.

    H_φ = - Σ_a Σ_i P(φ^i) θ_{φ^i}(a) log2 θ_{φ^i}(a),   P(φ^i) = Σ_a α_{φ^i}(a) / Σ_j Σ_a α_{φ^j}(a)

in bits, from the counts without α⁰, because with α⁰ features without counts would change the entropy. The caller
decides whether each state counts once or each visit counts.
Thesis: §3.3.2, Eq. 3.9-3.11.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

_DENSE = 8
"""Maximum ratio of configurations to counted contexts for a table with a row each; above it, sorting is faster."""


@dataclass(frozen=True, eq=False)
class CountedFeatures:
    """Counts of useful actions by configuration of a full feature set.

    codes : (n,) int64, of `features`, may repeat
    counts : (n, n_actions) float, at least 0, without α⁰

    Examples
    --------
    >>> columns = [[0, 0], [0, 1], [1, 0], [1, 1]]
    >>> counted = CountedFeatures.from_columns(columns, [[1, 0], [1, 0], [0, 1], [0, 1]])
    >>> counted.features.names, counted.entropy()
    (('f0', 'f1'), 0.0)
    """

    features: FeatureSet
    codes: NDArray[np.int64]
    counts: NDArray[np.float64]

    @classmethod
    def from_prior(cls, prior: ActionPrior, features: FeatureSet) -> "CountedFeatures":
        """The counts of a prior whose contexts are codes of `features`."""
        contexts = prior.contexts
        features.columns(contexts[[0, -1]] if len(contexts) else contexts)  # sorted: both ends lie within
        return cls(features, contexts, prior.counts(contexts))

    @classmethod
    def from_columns(
        cls, columns: ArrayLike, counts: ArrayLike, features: FeatureSet | None = None
    ) -> "CountedFeatures":
        """From rows of feature values (n, n_features) and their counts (n, n_actions).

        Without `features`, the features are f0, f1, … with the values from 0 to the largest in each column.
        """
        columns, counts = np.asarray(columns), np.asarray(counts, np.float64)
        if columns.ndim != 2 or counts.ndim != 2 or len(columns) != len(counts):
            raise InputError(f"columns and counts must have a row a context, got {columns.shape}, {counts.shape}")
        if not (np.isfinite(counts).all() and (counts >= 0).all()):
            raise InputError("counts must be finite and at least 0")
        if features is None:
            sizes = columns.max(axis=0, initial=0) + 1
            features = FeatureSet(tuple(f"f{i}" for i in range(columns.shape[1])), tuple(sizes.tolist()))
        return cls(features, features.codes(columns), counts)

    def entropy(self, names: Sequence[str] | None = None) -> float:
        """H_φ in bits (Eq. 3.11) of the features `names`, default all; 0 without counts."""
        return action_set_entropy(self._pooled(names))

    def action_entropies(self, names: Sequence[str] | None = None) -> NDArray[np.float64]:
        """H̄_φ(a) in bits (Eq. 3.9) of each action, (n_actions,); their sum is `entropy`. All 0 without counts."""
        counts = self._pooled(names)
        total = counts.sum()
        of_context = counts.sum(axis=1, keepdims=True)
        theta = np.divide(counts, of_context, out=np.ones_like(counts), where=counts > 0)
        return -(counts * np.log2(theta)).sum(axis=0) / total if total else np.zeros(counts.shape[1])

    def _pooled(self, names: Sequence[str] | None) -> NDArray[np.float64]:
        """Counts by configuration of the features `names`, (n_configurations, n_actions)."""
        names = self.features.names if names is None else names
        return pooled_counts(self.features.coarser(self.codes, names), self.counts)[1]


def action_set_entropy(counts: ArrayLike) -> float:
    """H_φ in bits of the counts (n_configurations, n_actions) of one feature set (Eq. 3.10, 3.11).

    Examples
    --------
    >>> action_set_entropy([[2, 2], [4, 0]])  # ½ · 1 bit + ½ · 0
    0.5
    """
    counts = np.asarray(counts, np.float64)
    total = float(counts.sum())
    return (float(_n_log_n(counts.sum(axis=1)).sum()) - float(_n_log_n(counts).sum())) / total if total else 0.0


def _n_log_n(n: NDArray[np.float64]) -> NDArray[np.float64]:
    # With n = Σ_a c(a), n log n - Σ_a c(a) log c(a) is n times the entropy of c / n: no division a row.
    return n * np.log2(np.where(n > 0, n, 1.0))


def pooled_counts(
    codes: NDArray[np.int64], counts: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Sum the counts of equal codes; return the ascending codes and their counts."""
    if not codes.size:
        return codes, counts
    top = int(codes.max()) + 1
    if top <= _DENSE * len(codes):
        total = np.stack([np.bincount(codes, column, top) for column in counts.T], axis=1).astype(np.float64)
        seen = np.flatnonzero(total.any(axis=1)).astype(np.int64)
        return seen, total[seen]
    order = np.argsort(codes, kind="stable")
    first = np.flatnonzero(np.diff(codes[order], prepend=codes[order[0]] - 1))
    return codes[order[first]], np.add.reduceat(counts[order], first, axis=0)
