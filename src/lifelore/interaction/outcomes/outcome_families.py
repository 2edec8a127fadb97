"""Families of outcomes for finding types of users: log likelihoods of users' outcomes as a matrix product.

The policy's mean or probabilities over all users count as `PSEUDO` outcomes of each type. A type whose users never
met a policy then has the outcomes of all users. Rows of outcomes have users in place of types.

A family has

    stats        sufficient statistics of each user's outcomes, (n_users, n_stats)
    fit(shares)  the most likely types, (n_types, n_stats), given the users' shares in types (n_users, n_types)

so that ``stats @ fit(shares).T`` are log likelihoods (n_users, n_types).
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.outcomes.outcome_rows import OutcomeRows

Array = NDArray[np.float64]

PSEUDO = 1.0
"""Number of outcomes of each type that a policy's distribution over all users counts as."""
FLOOR = 1e-3
"""Least deviation of a policy's outcomes within a type, as a share of the deviation of all outcomes."""


class GaussianFamily:
    """Stats: number, sum and sum of squares of each user's outcomes with each policy, (n_users, 3 n_policies)."""

    def __init__(self, rows: OutcomeRows) -> None:
        # Centred, because sums of squares of large outcomes lose digits.
        values = rows.values - rows.values.mean()
        parts = rows.sums(), rows.sums(values), rows.sums(values**2)
        self.stats = np.hstack(parts)
        number, total, _ = (part.sum(axis=0) for part in parts)
        self._overall = total / number
        self._least = max((FLOOR * values.std()) ** 2, 1e-300)

    def fit(self, shares: Array) -> Array:
        number, total, squares = np.split(shares.T @ self.stats, 3, axis=1)
        mean = (total + PSEUDO * self._overall) / (number + PSEUDO)
        spread = (squares - 2 * mean * total + number * mean**2).sum(axis=0) / number.sum(axis=0)
        variance = np.maximum(spread, self._least)
        flat = np.broadcast_to(-0.5 / variance, mean.shape)
        return np.hstack([-0.5 * np.log(2 * np.pi * variance) + flat * mean**2, mean / variance, flat])


class CategoricalFamily:
    """Stats: how often each user got each value with each policy, (n_users, n_values n_policies)."""

    def __init__(self, rows: OutcomeRows) -> None:
        values, place = np.unique(rows.values, return_inverse=True)
        self._n_values = len(values)
        self.stats = np.hstack([rows.sums((place == value).astype(float)) for value in range(len(values))])
        self._overall = self._by_value(self.stats.sum(axis=0)[None])
        self._overall = self._overall / self._overall.sum(axis=1, keepdims=True)

    def fit(self, shares: Array) -> Array:
        counts = self._by_value(shares.T @ self.stats) + PSEUDO * self._overall
        with np.errstate(divide="ignore"):
            logs = np.log(counts / counts.sum(axis=1, keepdims=True))
        # A value that a policy never gave has a count of 0 for every user, so its weight is irrelevant.
        return np.where(np.isfinite(logs), logs, 0.0).reshape(len(logs), -1)

    def _by_value(self, counts: Array) -> Array:
        return counts.reshape(len(counts), self._n_values, -1)


OutcomeFamily = GaussianFamily | CategoricalFamily
FAMILIES: dict[str, type[OutcomeFamily]] = {"gaussian": GaussianFamily, "categorical": CategoricalFamily}
"""Every family by its name."""
