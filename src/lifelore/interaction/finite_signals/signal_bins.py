"""Bins of real-valued outcomes, chosen so that they tell the types apart.

A policy's outcomes are often alike on most types and differ on a few. Bins of equal mass would resolve the noise
of the many. The outcome is therefore cut finely first. Then the two neighbouring bins whose union loses least
information about the type (all types equally likely) are joined, until few enough bins are left.

Shapes: T types, P policies. All policies are treated at once.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.normal_distribution import ndtr
from lifelore.interaction.finite_signals.signal_table import SignalTable

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

FINE = 48
"""Number of cuts of equal width, and of cuts at equal shares of the types' outcomes, before bins are joined."""
MOST_TYPES = 128
"""Largest number of types that cuts are chosen on; more costs time and changes little."""
_AT_ONCE = 1 << 20
"""Size of the largest temporary array."""
_TINY = 1e-300
"""In place of 0, so that every logarithm is finite."""
_STEPS = np.array([-2.0, -1.25, -0.65, -0.2, 0.2, 0.65, 1.25, 2.0])


def informative_cuts(mean: Array, deviation: Array, n_bins: int) -> Array:
    """Cuts of each policy's outcomes into at most `n_bins` bins that tell the types apart, (P, n_bins - 1).

    Outcomes are taken as normal: cuts need to be good, not best. They rise; cuts that are not needed are infinite.

    Parameters
    ----------
    mean, deviation : (T, P) float64
        Of each pair's outcomes.
    n_bins : int

    Raises
    ------
    InputError
        `n_bins` is below 2.
    """
    _check_bins(n_bins)
    n_types, n_policies = mean.shape
    if n_types > MOST_TYPES:
        # Types spread evenly over the range of means suffice: a thousand give the same cuts.
        some = np.argsort(mean, axis=0)[np.linspace(0, n_types - 1, MOST_TYPES).round().astype(np.int64)]
        mean, deviation = np.take_along_axis(mean, some, 0), np.take_along_axis(deviation, some, 0)
    step = max(1, _AT_ONCE // (len(mean) * 2 * FINE))
    parts = [
        _cuts(mean[:, at : at + step].T, deviation[:, at : at + step].T, n_bins)
        for at in range(0, n_policies, step)
    ]
    return np.concatenate(parts)


def normal_table(mean: Array, deviation: Array, n_bins: int) -> tuple[Array, SignalTable]:
    """The `informative_cuts` of normal outcomes, and P(bin | type, policy) between them; parameters as there."""
    cuts = informative_cuts(mean, deviation, n_bins)
    return cuts, SignalTable(normal_probs(mean, deviation, cuts))


def normal_probs(mean: Array, deviation: Array, cuts: Array) -> Array:
    """P(bin) of normals (...) between rising cuts (..., n), (..., n + 1); the outer bins reach to infinity."""
    return bin_probs(_below(mean, deviation, cuts))


def joined_table(probs: Array, n_bins: int) -> tuple[Ints, SignalTable]:
    """The `joined_ends` of cells (T, P, n) joined until at most `n_bins` are left, and P(bin | type, policy).

    Raises
    ------
    InputError
        `n_bins` is below 2.
    """
    _check_bins(n_bins)
    ends = joined_ends(probs.transpose(1, 0, 2), n_bins)
    return ends, SignalTable(joined(probs, ends))


def bin_probs(cumulative: Array) -> Array:
    """Probabilities of bins (..., n + 1) from distribution functions at their n cuts (..., n), at least 0."""
    found = np.ones((*cumulative.shape[:-1], cumulative.shape[-1] + 1))
    found[..., :-1] = cumulative
    found[..., 1:] -= cumulative
    return np.maximum(found, 0.0, out=found)


def joined_ends(bins: Array, n_bins: int) -> Ints:
    """One past the last bin of each joined bin of each policy, (P, min(n, n_bins)).

    In each step every policy joins the two neighbours whose union loses least information about the type.

    Parameters
    ----------
    bins : (P, T, n) float64
        P(bin | type, policy).
    n_bins : int
        At least 1.
    """
    n_policies, n_types, n = bins.shape
    # Flat arrays over (policy, bin). An empty bin before the first and one after the last are never joined.
    laws = np.full((n_policies, n + 2, n_types), _TINY)
    np.maximum(bins.transpose(0, 2, 1), _TINY, out=laws[:, 1:-1])
    certainty = _certainty(laws)
    certainty[:, [0, -1]] = np.inf
    united = np.zeros((n_policies, n + 2))
    united[:, :-1] = _certainty(laws[:, :-1] + laws[:, 1:])
    loss = np.full((n_policies, n + 2), np.inf)
    loss[:, :-1] = certainty[:, :-1] + certainty[:, 1:] - united[:, :-1]
    laws, by_policy, certainty, united = laws.reshape(-1, n_types), loss, certainty.ravel(), united.ravel()
    loss, first = loss.ravel(), np.arange(n_policies) * (n + 2)
    before, after = np.arange(loss.size) - 1, np.arange(loss.size) + 1
    for _ in range(n - n_bins):
        left = by_policy.argmin(axis=1) + first
        gone, earlier = after[left], before[left]
        right = after[gone]
        after[left], before[right], loss[gone] = right, left, np.inf
        laws[left] += laws[gone]
        certainty[left] = united[left]
        ones, others = np.concatenate([left, earlier]), np.concatenate([right, left])
        united[ones] = _certainty(laws[ones] + laws[others])
        loss[ones] = certainty[ones] + certainty[others] - united[ones]
    ends, place = np.empty((n_policies, min(n, n_bins)), np.int64), first + 1
    for number in range(ends.shape[1]):
        place = after[place]
        ends[:, number] = place - first - 1
    return ends


def joined(probs: Array, ends: Ints) -> Array:
    """Probabilities (..., T, P, n) with the bins up to each of a policy's `ends` (P, m) summed, (..., T, P, m)."""
    column = np.arange(probs.shape[-1])[:, None]
    starts = np.concatenate([np.zeros((len(ends), 1), np.int64), ends[:, :-1]], axis=1)
    member = (column >= starts[:, None]) & (column < ends[:, None])
    return np.matmul(probs[..., None, :], member.astype(np.float64))[..., 0, :]


def _check_bins(n_bins: int) -> None:
    """Raise InputError for fewer than two bins."""
    if n_bins < 2:
        raise InputError(f"n_bins must be at least 2, got {n_bins}")


def _cuts(mean: Array, deviation: Array, n_bins: int) -> Array:
    """`informative_cuts` of means and deviations (P, T)."""
    spread = np.sort((mean[..., None] + deviation[..., None] * _STEPS).reshape(len(mean), -1), axis=1)
    even = np.linspace(spread[:, 0], spread[:, -1], FINE, axis=1)
    # Quantiles; `np.quantile` imports for 9 ms at its first call.
    place = np.linspace(0, spread.shape[1] - 1, FINE)
    lower = place.astype(np.int64)
    shares = spread[:, lower] + (place - lower) * np.diff(spread, append=spread[:, -1:])[:, lower]
    cuts = np.sort(np.concatenate([even, shares], axis=1), axis=1)
    ends = joined_ends(bin_probs(_below(mean, deviation, cuts[:, None])), n_bins)
    chosen = np.full((len(cuts), n_bins - 1), np.inf)
    chosen[:, : ends.shape[1] - 1] = np.take_along_axis(cuts, ends[:, :-1] - 1, axis=1)
    return chosen


def _below(mean: Array, deviation: Array, cuts: Array) -> Array:
    """Distribution functions of normals (...) at cuts (..., n), (..., n)."""
    z = cuts - mean[..., None]
    z /= deviation[..., None]
    return ndtr(z)


def _certainty(bins: Array) -> Array:
    """Σ p log p over the types, less s log s of their sum s, of positive bins (..., T), (...).

    Joining two bins loses information: the sum of their certainties less that of their union, by T.
    """
    total = np.add.reduce(bins, axis=-1)
    return np.vecdot(bins, np.log(bins)) - total * np.log(total)
