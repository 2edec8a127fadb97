"""Whether counts of outcomes are of one type or of two, and which of several types are joined."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln

Array = NDArray[np.float64]


class JoinedType(NamedTuple):
    """Types that nothing tells apart.

    members : their names in memory
    """

    members: tuple[str, ...]

    @property
    def name(self) -> str:
        """The members' names."""
        return "+".join(self.members)


def log_evidence(counts: Array, base: Array) -> Array:
    """Log probability of sequences of outcomes under Dirichlet laws, (..., n_causes).

    Parameters
    ----------
    counts : (..., n_causes, n_outcomes) float
    base : (n_causes, n_outcomes) float
        Pseudo-observations; outcomes without any do not count.
    """
    safe = np.where(base > 0, base, 1.0)
    gain = np.where(base > 0, gammaln(safe + counts) - gammaln(safe), 0.0).sum(axis=-1)
    total = base.sum(axis=-1)
    return gain - (gammaln(total + counts.sum(axis=-1)) - gammaln(total))


def joined_types(counts: Array, apart: Callable[[Array, Array], float], least: float) -> list[list[int]]:
    """Groups of types that nothing tells apart, by number; the two least apart are joined first.

    Parameters
    ----------
    counts : (n_types, n_causes, n_outcomes) float
    apart : callable
        Evidence in nats that two counts (n_causes, n_outcomes) are of two types.
    least : float
        Evidence from which types stay apart.
    """
    groups, sums = [[number] for number in range(len(counts))], list(counts)
    pairs = {(i, j): apart(sums[i], sums[j]) for i in range(len(sums)) for j in range(i + 1, len(sums))}
    while pairs:
        i, j = min(pairs, key=pairs.__getitem__)
        if pairs[i, j] >= least:
            break
        groups[i] += groups[j]
        groups[j] = []
        sums[i] = sums[i] + sums[j]
        pairs = {
            pair: apart(sums[pair[0]], sums[pair[1]]) if i in pair else found
            for pair, found in pairs.items()
            if j not in pair
        }
    return [sorted(group) for group in groups if group]
