"""Bins of real-valued outcomes, chosen so that they tell the types apart.

A policy's outcomes are often alike on most types and differ on a few. Bins of equal mass would resolve the noise
of the many. The outcome is therefore cut finely first. Then the two neighbouring bins whose union loses least
information about the type (all types equally likely) are joined, until few enough bins are left.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable

Array = NDArray[np.float64]

FINE = 48
"""Number of cuts of equal width, and of cuts at equal shares of the types' outcomes, before bins are joined."""
MOST_TYPES = 128
"""Largest number of types that cuts are chosen on; more costs time and changes little."""
_STEPS = np.array([-2.0, -1.25, -0.65, -0.2, 0.2, 0.65, 1.25, 2.0])


class _Outcomes(Protocol):
    @property
    def mean(self) -> Array: ...

    @property
    def deviation(self) -> Array: ...

    def cumulative(self, policy: int, values: Array, types: Any = ...) -> Array: ...


def informative_table(outcomes: _Outcomes, n_bins: int) -> SignalTable:
    """P(bin | type, policy); each policy has cuts of its own, the first and last bin reach to infinity.

    Raises
    ------
    InputError
        `n_bins` is below 2.
    """
    check_bins(n_bins)
    n_types, n_policies = outcomes.mean.shape
    probs = np.empty((n_policies, n_types, n_bins))
    for policy in range(n_policies):
        probs[policy] = bin_probs(outcomes, policy, informative_cuts(outcomes, policy, n_bins), n_bins)
    return SignalTable(probs, copy=False)


def bin_probs(outcomes: _Outcomes, policy: int, cuts: Array, n_bins: int) -> Array:
    """P(bin | type) of a policy's outcomes between rising cuts, (n_types, n_bins); 0 in unused bins."""
    below = outcomes.cumulative(policy, cuts)
    found = np.diff(below, axis=1, prepend=0.0, append=1.0)
    probs = np.zeros((len(found), n_bins))
    probs[:, : found.shape[1]] = np.maximum(found, 0.0)
    return probs


def informative_cuts(outcomes: _Outcomes, policy: int, n_bins: int) -> Array:
    """The cuts of a policy's outcomes into at most `n_bins` bins, rising."""
    # Types spread evenly over the range of means suffice: a thousand give the same cuts.
    some = np.argsort(outcomes.mean[:, policy])
    some = some[np.unique(np.linspace(0, len(some) - 1, MOST_TYPES).round().astype(np.int64))]
    cuts = _fine_cuts(outcomes.mean[some, policy], outcomes.deviation[some, policy])
    below = outcomes.cumulative(policy, cuts, some)
    fine = np.maximum(np.diff(below, axis=1, prepend=0.0, append=1.0), 0.0)
    return cuts[joined_ends_of(fine, n_bins)[:-1] - 1]


def check_bins(n_bins: int) -> None:
    """Raise InputError for fewer than two bins."""
    if n_bins < 2:
        raise InputError(f"n_bins must be at least 2, got {n_bins}")


def joined_bins(fine: Array, n_bins: int) -> Array:
    """`fine` (n_types, n) with neighbours joined until at most `n_bins` columns are left; rows keep their sums."""
    return joined_to(fine, joined_ends_of(fine, n_bins))


def joined_to(fine: Array, ends: NDArray[np.int64]) -> Array:
    """`fine` (n_types, n) with the columns up to each of `ends` summed."""
    return np.add.reduceat(fine, np.concatenate([[0], ends[:-1]]), axis=1)


def joined_ends_of(fine: Array, n_bins: int) -> NDArray[np.int64]:
    """One past the last column of each joined bin."""
    if fine.shape[1] <= n_bins:
        return np.arange(1, fine.shape[1] + 1)
    from lifelore.interaction.finite_signals.bin_joining_kernels import joined_ends

    # A row for each bin, because the kernel reads whole bins; a copy, because it writes them.
    return joined_ends(np.array(fine.T, order="C"), n_bins)


def _fine_cuts(mean: Array, deviation: Array) -> Array:
    spread = (mean[:, None] + deviation[:, None] * _STEPS).ravel()
    even = np.linspace(spread.min(), spread.max(), FINE)
    return np.unique(np.concatenate([even, np.quantile(spread, np.linspace(0, 1, FINE))]))
