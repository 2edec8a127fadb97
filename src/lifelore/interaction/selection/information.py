"""Mutual information between the type and the signal of each policy: I(π) = H(Σ β F) − Σ β H(F), in nats.

The expected entropy of the belief after a signal is H(β) − I(π), by the symmetry of mutual information. This form
needs the mixture of signals instead of a posterior for each signal: T P S operations and P S logarithms. The
thesis (§4.5.2.2) prints another expression; see the errata.
"""

import numpy as np

from lifelore.core.metrics import entropy
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.prediction import weighted
from lifelore.interaction.selection.rule import Array
from lifelore.interaction.selection.support import truncated


def mutual_information(belief: Array, table: SignalTable, mass: float = 1.0) -> Array:
    """I(π) for every policy, (P,) or (k, P) nats, at least 0.

    Parameters
    ----------
    belief : (T,) or (k, T) float64
    table : SignalTable
    mass : float
        Share of the belief that is used, in (0, 1]: the least likely types are left out.
    """
    belief = truncated(belief, mass)
    noise = weighted(belief, table.conditional_entropy)
    # Only rounding makes the difference negative.
    return np.maximum(entropy(predicted_signals(belief, table)) - noise, 0.0)


def predicted_signals(belief: Array, table: SignalTable) -> Array:
    """P(signal | policy) = Σ β(τ) F(signal | τ, π), (P, S) or (k, P, S)."""
    mixed = weighted(belief, signals_by_type(table))
    return mixed.reshape(*mixed.shape[:-1], table.n_policies, table.n_signals)


def signals_by_type(table: SignalTable) -> Array:
    """The table with a row for each type, (T, P S) or (k, T, P S), so that one product serves all policies."""
    return table.probs.reshape(*table.probs.shape[:-2], -1)
