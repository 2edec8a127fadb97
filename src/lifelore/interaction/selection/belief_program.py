"""The exact optimal selection over a finite horizon: dynamic programming over beliefs. Thesis: Eq. 4.3, §4.5.

    V_k(w) = max_π [ Σ_τ w(τ) E[U | τ, π] + Σ_σ V_{k-1}(w · F(σ | ·, π)) ],   V_0 = 0

The thesis's Q has no horizon and diverges, and takes the expectation under the unknown type. Here the expectation
is under the belief, with a horizon. Beliefs w are not normalised: each carries the probability of the signals that
lead to it, so no division is needed. The tree has (n_policies n_signals)^k beliefs. It is a reference for small
problems (golf: 4 clubs, 7 categories, 3 shots), not a rule.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.library_names import checked_prior

Array = NDArray[np.float64]

LARGEST = 50_000_000
"""Numbers in the tree's last layer of beliefs, above which it is refused."""


class Plan(NamedTuple):
    """The optimal selection and its value.

    value : float
        Expected sum of utilities over the horizon.
    first : int
        Number of the first policy.
    values : (n_policies,) float64
        Q: the value of starting with each policy and selecting optimally afterwards.
    """

    value: float
    first: int
    values: Array


def best_plan(library: Any, horizon: int, belief: Array | None = None, n_bins: int = 8) -> Plan:
    """The optimal selection over `horizon` episodes from `belief`, by default the library's prior; exact.

    Utilities are the performance model's; signals are `library.table(n_bins)`.

    Raises
    ------
    InputError
        The horizon is below 1, the tree would be too large, or the belief is no distribution over the types.

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> round(best_plan(library, horizon=2).value, 1)
    14.6
    """
    table, mean = library.table(n_bins), library.performance.mean
    layers = _layers(table, library, belief, horizon)
    values = layers[-1] @ mean
    for weights in reversed(layers[:-1]):
        values = weights @ mean + _after_signals(values.max(axis=1), table)
    return Plan(float(values[0].max()), int(values[0].argmax()), values[0])


def _layers(table: SignalTable, library: Any, belief: Array | None, horizon: int) -> list[Array]:
    """Unnormalised beliefs before each episode: layer k is ((n_policies n_signals)^k, n_types)."""
    if horizon < 1:
        raise InputError(f"horizon must be at least 1, got {horizon}")
    branches = table.n_policies * table.n_signals
    if branches ** (horizon - 1) * table.n_types > LARGEST:
        raise InputError(
            f"a tree of {branches} branches and horizon {horizon} is too large; take fewer bins or episodes"
        )
    law = table.probs.transpose(1, 2, 0).reshape(branches, table.n_types)
    layers = [(library.prior if belief is None else checked_prior(belief, library.n_types))[None]]
    for _ in range(horizon - 1):
        layers.append((layers[-1][:, None, :] * law).reshape(-1, table.n_types))
    return layers


def _after_signals(value: Array, table: SignalTable) -> Array:
    """Values (n P S,) of the next layer summed over signals, (n, P)."""
    return value.reshape(-1, table.n_policies, table.n_signals).sum(axis=2)
