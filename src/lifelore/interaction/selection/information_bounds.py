"""Bounds on the mutual information of every policy at once, and scores whose best are exact.

Tables of up to 16 million numbers are estimated by a product in float32, with a bound on its rounding. Larger
tables take longer to read than a decision should take. There, tangents bound the information from above: I is
concave in the belief, so that for any law q of signals

    I(π) ≤ Σ β(τ) KL(F(· | τ, π) ‖ q),

with equality where q is the mixture of signals under β. `q` is the mixture under the flat belief; the divergences
are computed once for each table.
"""

from collections.abc import Callable, Iterable
from math import log

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.beliefs.belief import Array
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.selection.derived_arrays import DerivedArrays
from lifelore.interaction.selection.exact_best import exact_best
from lifelore.interaction.selection.information import (
    Ints,
    expected_noise,
    information_of,
    mutual_information,
    spread_out,
)
from lifelore.interaction.selection.signal_rows import (
    MOST_NUMBERS,
    NEGLIGIBLE,
    ROUNDING,
    SignalRows,
    signal_rows,
)
from lifelore.interaction.selection.support import supported_types

Scored = Callable[[Array, Ints | slice], Array]
"""The scores of some policies from their information; a score rises with the information."""
EVERY = slice(None)
_TINY = np.float32(1e-37)


def scores_by_information(
    belief: Array, table: SignalTable, mass: float, scored: Scored, always: bool = False
) -> Array:
    """The scores of every policy, (..., n_policies), quickly for a single belief.

    The scores of all policies that may be best are exact. Other scores are too high. In tables of up to 16 million
    numbers their information is at most `width` (see `rounded_bound`) too high, less than 1e-4 nats for 68 types
    and 50 signals. So is the best score's where no other policy comes close, unless `always`. In larger tables
    they may be much too high, but not as high as the best. Many beliefs are scored exactly.
    """
    belief = np.asarray(belief, np.float64)
    rows = signal_rows(table) if belief.ndim == 1 else None
    if belief.ndim > 1 or (rows is None and table.probs.size <= MOST_NUMBERS):
        return scored(mutual_information(belief, table, mass), EVERY)
    support, share = supported_types(belief, mass)
    noise = expected_noise(support, share, table)

    def exact(policies: Ints) -> Array:
        return scored(information_of(policies, support, share, noise, table), policies)

    if rows is None:
        return exact_best(scored(tangent_bound(support, share, table), EVERY), -np.inf, exact)
    upper, width = rounded_bound(support, share, noise, rows)
    scores = scored(upper, EVERY)
    at = int(scores.argmax())
    best = slice(at, at + 1)
    return exact_best(scores, scored(np.maximum(upper[best] - width, 0.0), best)[0], exact, always)


def rounded_bound(support: Ints, share: Array, noise: Array, rows: SignalRows) -> tuple[Array, float]:
    """An upper bound on I(π) of every policy, (n_policies,) nats, by a product in float32.

    Returns
    -------
    bound : (n_policies,) float64
    width : float
        The information is at least the bound minus this number.
    """
    n_types, values = len(rows.values), rows.values
    if 4 * len(support) > n_types:
        share = spread_out(support, share, n_types)
    else:
        values = values[support]
    weights = share.astype(np.float32)
    if np.minimum.reduce(share) < NEGLIGIBLE:
        weights[weights < NEGLIGIBLE] = 0
    mixed = (weights @ values).reshape(rows.n_policies, rows.n_signals)
    np.maximum(mixed, _TINY, out=mixed)
    error = rounding_of_information(len(support), rows.n_signals)
    return error - (np.vecdot(mixed, np.log(mixed)) + noise), 2 * error


def rounding_of_information(n_types: int, n_signals: int) -> float:
    """Largest error in nats of an information that is computed in float32 from so many types and signals."""
    # Each signal's probability m has a relative error of at most (types + 2) roundings, which moves m log m by
    # at most m (1 + |log m|) of it. Logarithm and sum add (signals + 4) roundings of H(m) <= log(signals).
    return ROUNDING * (n_types + n_signals + 6) * (1.0 + log(n_signals))


def tangent_bound(support: Ints, share: Array, table: SignalTable) -> Array:
    """An upper bound on I(π) of every policy, (n_policies,) nats."""
    divergence = _divergence(table)
    if len(support) < table.n_types:
        divergence = divergence[:, support]
    bound = divergence @ share.astype(np.float32)
    # The bound and, in a table of float32, the exact value are rounded.
    return bound.astype(np.float64) + 2 * rounding_of_information(len(support), table.n_signals)


def _fill(divergence: NDArray[np.float32], table: SignalTable, policies: Iterable[int]) -> None:
    """KL(F(· | τ, π) ‖ the mixture under the flat belief), (n_policies, n_types)."""
    for policy in policies:
        laws = table.probs[policy]
        mixed = laws.mean(axis=0, dtype=np.float64)
        logs = np.log(np.where(mixed > 0, mixed, 1.0)).astype(laws.dtype)
        divergence[policy] = -(laws @ logs) - table.conditional_entropy[policy]


_divergence = DerivedArrays(lambda table: np.empty(table.conditional_entropy.shape, np.float32), _fill)
