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
from lifelore.interaction.selection.type_classes import TypeClasses, type_classes

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
        return _of_one(belief, table, mass) if belief.ndim == 1 else _of_many(belief, table, mass)

    return in_blocks(belief, table.n_policies * table.n_signals, scored)


def expected_entropy(belief: Array, table: SignalTable, mass: float = 1.0) -> Array:
    """Expected entropy in nats of the belief after a signal of each policy, (..., n_policies)."""
    return entropy(belief)[..., None] - mutual_information(belief, table, mass)


def _of_one(belief: Array, table: SignalTable, mass: float) -> Array:
    support, share = supported_types(belief, mass)
    law, classes = table.probs, type_classes(table)
    if 2 * len(support) > len(belief) and not classes.few:
        # Reading all rows in order is as fast as picking most rows.
        whole = np.zeros(len(belief))
        whole[support] = share
        mixed = np.matmul(whole.astype(law.dtype, copy=False), law)
        return _difference(mixed, table.conditional_entropy @ whole)
    weights = share.astype(law.dtype, copy=False)
    if kernel_pays(len(support) * table.n_policies * table.n_signals):
        mixed = _compiled_mixtures(weights, support, law, classes)
    elif classes.few:
        mixed = class_mixtures(weights, support, classes.of_type, law)
    else:
        mixed = mixtures(weights, support, law)
    return _difference(mixed, table.conditional_entropy[:, support] @ share)


def _compiled_mixtures(weights: Array, support: NDArray[np.int64], law: Array, classes: TypeClasses) -> Array:
    from lifelore.interaction.selection import information_kernels

    mixed = np.empty((law.shape[0], law.shape[2]), law.dtype)
    if classes.few:
        information_kernels.class_mixtures(weights, support, classes.of_type, law, mixed)
    else:
        information_kernels.mixtures(weights, support, law, mixed)
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
