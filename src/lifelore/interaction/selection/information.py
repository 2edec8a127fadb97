"""Mutual information between the type and the signal of each policy: I(π) = H(Σ β F) − Σ β H(F), in nats.

The expected entropy of the belief after a signal is H(β) − I(π), by the symmetry of mutual information. This form
needs the mixture of signals instead of a posterior for each signal: T P S operations and P S logarithms. The
thesis (§4.5.2.2) prints another expression; see the errata.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.compiler_start import kernel_pays
from lifelore.interaction.beliefs.belief import Array, entropy
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.selection.mixtures import class_mixtures, mixtures
from lifelore.interaction.selection.rule import in_blocks
from lifelore.interaction.selection.support import supported_types, truncated
from lifelore.interaction.selection.type_classes import type_classes

Ints = NDArray[np.int64]

_TINY = np.float32(1e-37)


def mutual_information(belief: Array, table: SignalTable, mass: float = 1.0) -> Array:
    """I(π) for every policy, (..., n_policies) nats, at least 0.

    Parameters
    ----------
    belief : (..., n_types) float
    table : SignalTable
    mass : float
        Share of the belief that is used, in (0, 1]: the least likely types are left out.
    """

    def scored(belief: Array) -> Array:
        if belief.ndim > 1:
            return _of_many(belief, table, mass)
        support, share = supported_types(belief, mass)
        noise = expected_noise(support, share, table)
        return information_of(None, support, share, noise, table)

    return in_blocks(belief, table.n_policies * table.n_signals, scored)


def expected_entropy(belief: Array, table: SignalTable, mass: float = 1.0) -> Array:
    """Expected entropy in nats of the belief after a signal of each policy, (..., n_policies)."""
    return entropy(belief)[..., None] - mutual_information(belief, table, mass)


def expected_noise(support: Ints, share: Array, table: SignalTable) -> Array:
    """Σ β H(F), the part of the signals' entropy that tells nothing of the type, (n_policies,) nats."""
    if 2 * len(support) > table.n_types and not type_classes(table).few:
        return table.conditional_entropy @ spread_out(support, share, table.n_types)
    return table.conditional_entropy[:, support] @ share


def spread_out(support: Ints, share: Array, n_types: int) -> Array:
    """The shares of all types, (n_types,), 0 outside the support."""
    if len(support) == n_types:
        return share
    whole = np.zeros(n_types)
    whole[support] = share
    return whole


def information_of(policies: Ints | None, support: Ints, share: Array, noise: Array, table: SignalTable) -> Array:
    """I(π) of some policies in the precision of the table, (n,) nats.

    Parameters
    ----------
    policies : (n,) int64, or None for all
    support, share : (k,) int64 and float64
        As `supported_types` gives them.
    noise : (n_policies,) float
        As `expected_noise` gives it.
    table : SignalTable
    """
    law, classes = table.probs, type_classes(table)
    if 2 * len(support) > table.n_types and not classes.few:
        # Reading all rows in order is as fast as picking most rows.
        whole = spread_out(support, share, table.n_types).astype(law.dtype, copy=False)
        if policies is None:
            return _difference(np.matmul(whole, law), noise)
        return _difference(np.array([np.matmul(whole, law[policy]) for policy in policies]), noise[policies])
    policies = np.arange(table.n_policies) if policies is None else policies
    weights = share.astype(law.dtype, copy=False)
    if kernel_pays(len(support) * len(policies) * table.n_signals):
        mixed = _compiled_mixtures(weights, support, policies, table)
    elif classes.few:
        mixed = class_mixtures(weights, support, classes.of_type, policies, law)
    else:
        mixed = mixtures(weights, support, policies, law)
    return _difference(mixed, noise[policies])


def _compiled_mixtures(weights: Array, support: Ints, policies: Ints, table: SignalTable) -> Array:
    from lifelore.interaction.selection import information_kernels

    law, classes = table.probs, type_classes(table)
    mixed = np.empty((len(policies), table.n_signals), law.dtype)
    if classes.few:
        information_kernels.class_mixtures(weights, support, classes.of_type, policies, law, mixed)
    else:
        information_kernels.mixtures(weights, support, policies, law, mixed)
    return mixed


def _of_many(belief: Array, table: SignalTable, mass: float) -> Array:
    belief = truncated(belief, mass)
    mixed = np.matmul(belief.astype(table.probs.dtype, copy=False), table.probs).transpose(1, 0, 2)
    return _difference(mixed, belief @ table.conditional_entropy.T)


def _difference(mixed: Array, noise: Array) -> Array:
    # 0 log 0 is 0, with any finite number in place of the logarithm.
    logs = np.log(np.maximum(mixed, _TINY))
    # Only rounding makes it negative.
    return np.maximum(-np.einsum("...s,...s->...", logs, mixed) - noise, 0.0)
