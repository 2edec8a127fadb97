"""A finite alphabet for signals of any kind: signals that were simulated or stored for each type and policy.

For a policy π, n signals of each of T types are T n letters s. A letter stands for all signals near it, and the
probability that type τ gives it is that of importance sampling from the mixture of all types:

    P(s | τ, π) = F(s | τ, π) / Σ_τ' F(s | τ', π) / n,  rows scaled to sum to 1

Sums over the table are then estimates of expectations over signals, for any rule that looks ahead.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from lifelore.core.streams import stream
from lifelore.interaction.finite_signals.signal_table import SignalTable

LETTERS = 128
"""Largest number of letters of a policy, where there are no more types than that."""

Sample = Callable[[np.random.Generator, int, int], Any]
"""``sample(generator, type, policy)`` gives a signal, simulated or stored."""


def simulated_table(
    log_likelihood: Callable[[int, Any], Any], sample: Sample, n_types: int, n_policies: int, n: int
) -> SignalTable:
    """The table of `n` signals of each type and policy, fewer where they would be more than `LETTERS`.

    Parameters
    ----------
    log_likelihood : callable
        ``log_likelihood(policy, signal)`` gives (n_types,); minus infinity is allowed.
    sample : callable
        Its draws are the same at each call of this function.
    """
    generator, n = stream(0, "simulated signals"), max(1, min(n, LETTERS // n_types))
    found = np.empty((n_policies, n_types * n, n_types))
    for policy in range(n_policies):
        drawn = [sample(generator, type_, policy) for type_ in range(n_types) for _ in range(n)]
        found[policy] = [log_likelihood(policy, signal) for signal in drawn]
    top = found.max(axis=-1, keepdims=True)
    shares = np.exp(found - np.where(top > -np.inf, top, 0.0))
    total = shares.sum(axis=-1, keepdims=True)
    # A letter that no type gives, not even its own, tells nothing.
    shares = np.divide(shares, total, out=np.full_like(shares, 1 / n_types), where=total > 0)
    probs = shares.transpose(2, 0, 1)
    total = probs.sum(axis=-1, keepdims=True)
    # A type that gives none of the letters gives all alike.
    return SignalTable(np.divide(probs, total, out=np.full_like(probs, 1 / probs.shape[-1]), where=total > 0))
