"""Explains the entropy of a context: tasks have different best actions, or features are too poor (§3.3.2)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.counted_features import CountedFeatures, pooled_counts
from lifelore.action.features.feature_set import FeatureSet

REASONS = ("certain", "tasks disagree", "features too poor", "too few counts")


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Reasons for the entropy of each context of a feature set, compared with the full set.

    columns : (m, n_chosen) int64, the contexts
    share : (m,) P(φ^i), sums to 1
    entropy : (m,) H[θ_{φ^i}] in bits
    with_all : (m,) mean entropy in the context if all features are known, bits; at most `entropy`
    counts_each : (m,) mean counts of the full configurations in the context
    reason : (m,) index into `REASONS`
    """

    features: FeatureSet
    columns: NDArray[np.int64]
    share: NDArray[np.float64]
    entropy: NDArray[np.float64]
    with_all: NDArray[np.float64]
    counts_each: NDArray[np.float64]
    reason: NDArray[np.int64]

    @property
    def disagreement(self) -> float:
        """Bits of H_φ that no feature explains: tasks have different best actions, or several actions tie."""
        return float(self.share @ self.with_all)

    @property
    def poverty(self) -> float:
        """Bits of H_φ that the features outside the set explain; `disagreement` + `poverty` = H_φ."""
        return float(self.share @ (self.entropy - self.with_all))

    def share_of(self, reason: str) -> float:
        """Share of all counts that lie in contexts of this reason, one of `REASONS`."""
        return float(self.share[self.reason == REASONS.index(reason)].sum())


def why_uncertain(
    counted: CountedFeatures, names: Sequence[str], high: float = 0.5, enough: float = 5.0
) -> Uncertainty:
    """Why contexts have a high entropy: tasks disagree, features are too poor, or counts are too few (§3.3.2).

    The entropy of a context is the sum of two parts: the part that remains if all features are known, and the part
    that they explain. The larger part is the reason. A full configuration with few counts seems certain, so the
    reason is "too few counts" if the full configurations have fewer than `enough` counts on average.

    Parameters
    ----------
    counted : CountedFeatures
        Counts over the full set, "the most informative set of observation features".
    names : sequence of str
        The chosen features.
    high : float
        Bits above which the entropy of a context counts as high.
    enough : float
        Least mean counts of the full configurations in a context for another reason than "too few counts".

    Examples
    --------
    >>> counted = CountedFeatures.from_columns([[0], [0], [1], [1]], [[9, 0], [0, 9], [9, 0], [9, 0]])
    >>> why_uncertain(counted, ["f0"]).entropy.round(2).tolist()
    [1.0, -0.0]
    """
    features = counted.features
    fine_codes, fine = pooled_counts(counted.codes, counted.counts)
    coarse_of_fine = features.coarser(fine_codes, names)
    codes, counts = pooled_counts(coarse_of_fine, fine)
    place = np.searchsorted(codes, coarse_of_fine)
    total = counts.sum(axis=1)
    left = np.bincount(place, fine.sum(axis=1) * _row_entropy(fine), len(codes)) / total
    each = total / np.bincount(place, minlength=len(codes))
    entropy = _row_entropy(counts)
    reason = np.where(2 * left >= entropy, 1, 2)
    reason = np.select([entropy <= high, each < enough], [0, 3], reason)
    chosen = features.subset(names)
    share = total / total.sum()
    return Uncertainty(chosen, chosen.columns(codes), share, entropy, left, each, reason.astype(np.int64))


def _row_entropy(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Entropy in bits of each row's proportions, (n,); every row has counts."""
    share = counts / counts.sum(axis=1, keepdims=True)
    return -(share * np.log2(np.where(share > 0, share, 1.0))).sum(axis=1)
