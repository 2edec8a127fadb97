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
    gain, known = np.zeros(counts.shape), (counts > 0) & (base > 0)
    before = np.broadcast_to(base, counts.shape)[known]
    gain[known] = gammaln(before + counts[known]) - gammaln(before)
    gain, total = gain.sum(axis=-1), base.sum(axis=-1)
    return gain - (gammaln(total + counts.sum(axis=-1)) - gammaln(total))


def joined_types(counts: Array, base: Array, apart: Callable[[Array], Array], least: float) -> list[list[int]]:
    """Groups of types that nothing tells apart, by number; the two least apart are joined first.

    Parameters
    ----------
    counts : (n_types, n_causes, n_outcomes) float
    base : (n_causes, n_outcomes) float
        See `log_evidence`.
    apart : callable
        From the evidence (n, n_causes) in nats of each cause that pairs are two types, what all causes tell, (n,).
    least : float
        Evidence from which types stay apart.
    """
    n, sums = len(counts), counts.copy()
    alone, groups = log_evidence(sums, base), [[number] for number in range(n)]

    def against(one: int, others: NDArray[np.int64]) -> Array:
        # A cause that one of two types has not shown tells nothing: its evidence is 0.
        return apart(alone[one] + alone[others] - log_evidence(sums[one] + sums[others], base))

    pairs = np.full((n, n), np.inf)
    for one in range(n - 1):
        pairs[one, one + 1 :] = against(one, np.arange(one + 1, n))
    while n > 1 and pairs.min() < least:
        one, other = divmod(int(pairs.argmin()), n)
        groups[one] += groups[other]
        groups[other] = []
        sums[one] += sums[other]
        alone[one] = log_evidence(sums[one], base)
        pairs[other] = pairs[:, other] = np.inf
        left = np.array([number for number in range(n) if groups[number] and number != one], np.int64)
        pairs[np.minimum(one, left), np.maximum(one, left)] = against(one, left)
    return [sorted(group) for group in groups if group]
