"""Dirichlet laws of a row of probabilities, known from counts and from what one task has shown.

Given a type, the probabilities of a pair have a Dirichlet law around those of the library, p, with the weight of
A = 1 / (1/N + ρ) observations: N counts behind p, ρ the spread of the tasks of a type. After counts c of the task
the law is Dirichlet(A p + c); the next category i has the probability (A pᵢ + cᵢ) / (A + Σ c).
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.outcomes.special_functions import gammaln
from lifelore.interaction.outcomes.spread import GRID, Spread, held_out, likeliest

Array = NDArray[np.float64]


class DirichletRow:
    """The laws of one policy's categories in one task, for every type and spread.

    Parameters
    ----------
    counts : (n_types, n_categories) float64
        Of the library, pseudo-counts included.
    spread : Spread
    """

    def __init__(self, counts: Array, spread: Spread) -> None:
        total = counts.sum(axis=1)
        self.weight: Array = 1 / (1 / total + spread.values[:, None])
        self.prior: Array = self.weight[:, :, None] * (counts / total[:, None])
        self.shown: Array = np.zeros(counts.shape[1])

    def probs(self) -> Array:
        """P(next category | type) by spread, (n_spreads, n_types, n_categories)."""
        return (self.prior + self.shown) / (self.weight + self.shown.sum())[:, :, None]

    def log_probability(self, category: int) -> Array:
        """Log probability of the next category by spread and type, (n_spreads, n_types)."""
        weight = self.prior[:, :, category] + self.shown[category]
        found = np.full(weight.shape, -np.inf)
        return np.log(weight / (self.weight + self.shown.sum()), out=found, where=weight > 0)

    def mean_and_variance(self, values: Array) -> tuple[Array, Array]:
        """Expectation of a number of each category (n_categories,), and what is not known about it; by spread."""
        probs = self.probs()
        mean = probs @ values
        within = probs @ values**2 - mean**2
        return mean, np.maximum(within, 0.0) / (self.weight + self.shown.sum() + 1)


def first_log_probability(counts: Array, spread: Spread, category: int) -> Array:
    """`DirichletRow.log_probability` of a row that has shown nothing, for one category alone; the same bits."""
    total = counts.sum(axis=1)
    all_weight = 1 / (1 / total + spread.values[:, None])
    weight = all_weight * (counts[:, category] / total)
    return np.log(weight / all_weight, out=np.full(weight.shape, -np.inf), where=weight > 0)


def spread_of_counts(counts: Array, pseudo_count: float) -> Spread:
    """The spreads that the types of counts (n_policies, n_types, n_categories) leave possible.

    Each type's own counts are predicted by the laws of the other types (Dirichlet-multinomial).
    """
    n_policies, n_types, n_categories = counts.shape
    if n_types < 2:
        return Spread.known(0.0)
    total = counts.sum(axis=2, keepdims=True)
    probs, seen = counts / total, np.maximum(counts - pseudo_count, 0.0)
    some = held_out(n_types, n_types * n_policies * n_categories)
    found = np.empty((len(GRID), len(some), n_types))
    for number, value in enumerate(GRID):
        prior = 1 / (1 / total + value) * probs
        weight, at_prior = prior.sum(axis=2), np.where(prior > 0, gammaln(np.where(prior > 0, prior, 1.0)), 0.0)
        for place, i in enumerate(some):
            own = seen[:, i, None]
            after = np.where(prior + own > 0, gammaln(np.where(prior + own > 0, prior + own, 1.0)), 0.0)
            gain = np.where((prior > 0) | (own == 0), after - at_prior, -np.inf).sum(axis=2)
            found[number, place] = (gain + gammaln(weight) - gammaln(weight + own.sum(axis=2))).sum(axis=0)
            found[number, place, i] = -np.inf
    found = np.maximum(found, -1e300)
    return Spread.up_to(likeliest(found))
