"""Gains of knowledge: exact for some policies, in float32 for all, and of joined signals where tables are large.

With weighted means w(τ, q) = β(τ) E[U | τ, q] the gain of a policy π is

    v(π) = Σ_σ max_q Σ_τ w(τ, q) F(σ | τ, π) − max_q Σ_τ w(τ, q),

a product for each policy. `KnowledgeGradient` has the meaning of it.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.beliefs.belief import Array
from lifelore.interaction.finite_signals.signal_bins import MOST_TYPES, joined_ends_of, joined_to
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.selection.derived_arrays import DerivedArrays
from lifelore.interaction.selection.information import Ints
from lifelore.interaction.selection.signal_rows import NEGLIGIBLE, ROUNDING, SignalRows
from lifelore.interaction.selection.type_classes import type_classes

JOINED = 4
"""Number of joined signals of each policy in the screen of large tables; more costs time and misses less."""
_AT_ONCE = 1 << 20
"""Size of the largest product in float32."""


def exact_gain(policies: Ints, support: Ints, weighted_means: Array, table: SignalTable) -> Array:
    """v(π) of some policies in the precision of the table, (n,).

    Parameters
    ----------
    policies : (n,) int64
    support : (k,) int64
    weighted_means : (k, n_candidates) float64
        The belief times the mean of each candidate on each type of the support.
    table : SignalTable
    """
    # The kernel's products are those of SciPy's BLAS, so there is no NumPy twin with the same bits.
    from lifelore.interaction.selection.information_kernels import best_after_signals

    classes, best = type_classes(table), np.empty(len(policies))
    weighted = np.ascontiguousarray(weighted_means).astype(table.probs.dtype, copy=False)
    best_after_signals(weighted, support, classes.of_type, classes.number, policies, table.probs, best)
    return best - weighted_means.sum(axis=0).max()


def rounded_gain(support: Ints, weighted_means: Array, rows: SignalRows) -> tuple[Array, float]:
    """v(π) of every policy by products in float32, (n_policies,), and its largest error."""
    weighted, scale, size = _less_best(weighted_means)
    values = rows.values if len(support) == len(rows.values) else rows.values[support]
    step = max(1, _AT_ONCE // (weighted.shape[1] * rows.n_signals)) * rows.n_signals
    ones = np.ones(rows.n_signals, np.float32)
    # The best policy now is a candidate with products of 0, so no largest product is negative.
    # BLAS may set the flag of an invalid operation on lanes of the processor that hold no number of the product.
    with np.errstate(invalid="ignore"):
        parts = [
            np.dot(weighted.T, values[:, at : at + step]).max(axis=0).reshape(-1, rows.n_signals) @ ones
            for at in range(0, values.shape[1], step)
        ]
    found = parts[0] if len(parts) == 1 else np.concatenate(parts)
    # Each product of n types has an error of (n + 2) roundings of the sum of the sizes of its terms.
    return scale * found.astype(np.float64), ROUNDING * (len(support) + rows.n_signals + 4) * size


def joined_gain(support: Ints, weighted_means: Array, table: SignalTable) -> Array:
    """A lower bound on v(π) of every policy, (n_policies,), up to rounding: the gain of coarser signals.

    Neighbouring signals of each policy are joined until `JOINED` are left, so that least information about the
    type is lost. Joined once for each table, on up to 128 types.
    """
    weighted, scale, _ = _less_best(weighted_means)
    laws = _screen(table)
    laws = laws if len(support) == len(laws) else laws[support]
    n_policies, found = table.n_policies, np.zeros(table.n_policies)
    left = np.repeat(weighted.sum(axis=0)[:, None], n_policies, axis=1)
    # The last signal's products are the rest of the sum over signals.
    for at in range(0, laws.shape[1], n_policies):
        product = np.dot(weighted.T, laws[:, at : at + n_policies])
        left -= product
        found += product.max(axis=0)
    return scale * (found + left.max(axis=0))


def _less_best(weighted_means: Array) -> tuple[NDArray[np.float32], float, float]:
    """Weighted means less those of the policy that is best now, in float32 and divided by `scale`.

    The gain is then the sum of largest products, without the difference of two large numbers.

    Returns
    -------
    weighted : (k, n_candidates) float32
    scale : float
        1, where float32 can hold the numbers as they are.
    size : float
        Sum over types of the largest number in size.
    """
    less = weighted_means - weighted_means[:, weighted_means.sum(axis=0).argmax(), None]
    largest, scale = max(float(np.maximum.reduce(less, None)), -float(np.minimum.reduce(less, None))), 1.0
    if largest > 0 and not 1e-4 < largest < 1e10:
        scale = largest
        less /= scale
    weighted = less.astype(np.float32)
    size = np.abs(weighted)
    sizes = size.max(axis=1)
    if sizes.min() < 1e-12 * largest / scale:
        weighted[size < NEGLIGIBLE] = 0
    return weighted, scale, scale * float(sizes.sum())


def _empty(table: SignalTable) -> NDArray[np.float32]:
    return np.empty((table.n_types, (JOINED - 1) * table.n_policies), np.float32)


def _fill(screen: NDArray[np.float32], table: SignalTable, policies: Iterable[int]) -> None:
    """P(joined signal | type, policy) of all but the last joined signal; policies vary fastest."""
    some = np.unique(np.linspace(0, table.n_types - 1, MOST_TYPES).round().astype(np.int64))
    for policy in policies:
        laws = table.probs[policy]
        ends = joined_ends_of(laws[some].astype(np.float64), JOINED)
        joined = np.zeros((table.n_types, JOINED), np.float32)
        joined[:, : len(ends)] = joined_to(laws, ends)
        screen[:, policy :: table.n_policies] = joined[:, :-1]


_screen = DerivedArrays(_empty, _fill)
