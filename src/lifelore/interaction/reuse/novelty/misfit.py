"""The statistic of an alarm: how badly the known types fit what tasks have shown.

What a task has shown of a policy is compared with what the runs of a type say, given what both leave in doubt (n
runs of a pair, spread ρ of the tasks of a type):

    outcomes   x̄ ~ N(m, v (1/k + 1/n + ρ)) for k outcomes of mean x̄
    cells      χ² = 2 Σ c log(c / k) − 2 log P(c | τ, π) for counts c, P Dirichlet-multinomial

For outcomes the statistic is the log odds of a new type against the known types. A new type resembles a known
type, but lies nearer the mean of all types (`ALIKE`), so that the policies which suit the known type best pay
less; or it is as broad as all types together (`unknown_law`). Where only one type is known, the new type which
resembles it pays less on all policies (`LESS`).

For cells the statistic is (min_τ Σ_π χ²(τ, π) − d) / √(2d), over the d degrees of freedom of the policies that a
task has tried.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.law import Numbers
from lifelore.interaction.outcomes.log_probability import log_of
from lifelore.interaction.outcomes.special_functions import gammaln
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.reuse.unknown_law import broad_moments
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]

LARGEST = 1e6
"""Largest misfit of a pair, so that impossible signals leave the sums finite."""
ALIKE = 0.9
"""Distance of a new type from the mean of all types, as a share of that of the known type which it is like."""
LESS = 2.0
"""Deviations by which a new type pays less than a single known type; more finds large differences by fewer
signals, and small differences by more."""
BREADTH = 1.0
"""Least variance of a broad type's means, in variances of an outcome: few types, or types that are alike, do not
tell how far a new type may lie from them."""


class Misfit:
    """The statistic of tasks, signal by signal.

    Parameters
    ----------
    rows : ReuseAlgorithm
        Of the same tasks, of `unknown_evidence`; `observe` teaches them too.

    Attributes
    ----------
    n_signals, freedom : (n_tasks,) float64
    by_type : (n_tasks, n_kinds) float64
        Sums over the policies that a task has tried, for each kind of tasks of the pairs.
    """

    def __init__(self, rows: ReuseAlgorithm) -> None:
        self.rows, self._pairs = rows, pairs_of(rows.library.signal, np.exp(rows.log_prior))
        self.n_signals, self.freedom = np.zeros((2, rows.n_users))
        self.by_type = np.zeros((rows.n_users, self._pairs.n_kinds))

    def observe(self, tasks: Numbers, policies: Numbers, signals: Any) -> None:
        """Take in a signal of each of `tasks`; errors as for `ReuseAlgorithm.observe`."""
        statistics = self.rows.unknown.shown
        before = self._pairs.misfit(statistics[tasks, policies], policies)
        first = ~statistics[tasks, policies].any(axis=-1)
        self.rows.observe(tasks, policies, signals)
        self.by_type[tasks] += self._pairs.misfit(statistics[tasks, policies], policies) - before
        self.freedom[tasks] += self._pairs.freedom * first
        self.n_signals[tasks] += 1

    def statistic(self, tasks: Numbers) -> Any:
        """The statistic of `tasks` (...), (...) float64; 0 before the first signal."""
        return self._pairs.statistic(self.by_type[tasks], self.freedom[tasks])


class MeanPairs:
    """Mean outcomes under the known types, new types that are like them, and a broad type: in this order.

    Attributes
    ----------
    freedom : float
        Degrees of freedom of a policy.
    n_kinds : int
        Kinds of tasks that signals are compared with.
    """

    freedom = 1.0

    def __init__(self, model: GaussianOutcomes, prior: Array) -> None:
        known, broad = model.moments, broad_moments(model.moments, prior)
        mean, doubt = means_of_types(model, prior)
        # A single type has no mean of all types to be nearer to.
        less = (1 - ALIKE) * (mean - prior @ mean) if len(prior) > 1 else LESS * np.sqrt(known.variance)
        # Policy first: a signal reads the row of a policy.
        self._mean = np.concatenate([mean, mean - less, broad.mean]).T
        self._variance = np.concatenate([known.variance, known.variance, broad.variance]).T
        self._doubt = np.concatenate([doubt, doubt, np.maximum(1 / broad.count, BREADTH)]).T
        self._log_prior = log_of(np.concatenate([prior, prior / 2, [0.5]]))
        self.n_kinds = len(self._log_prior)

    def misfit(self, moments: Array, policies: Numbers) -> Array:
        """−2 log P of mean outcomes of `policies` (...), (..., n_kinds); 0 where nothing is shown."""
        count, mean = moments[..., None, 0], moments[..., None, 1]
        variance = self._variance[policies] * (1 / np.maximum(count, 1e-300) + self._doubt[policies])
        found = (mean - self._mean[policies]) ** 2 / variance + np.log(variance)
        return np.where(count > 0, np.minimum(found, LARGEST), 0.0)

    def statistic(self, misfit: Array, freedom: Array) -> Array:
        """Log odds of a new type without their prior, from sums (..., n_kinds)."""
        terms, n_types = self._log_prior - misfit / 2, self.n_kinds // 2
        return np.logaddexp.reduce(terms[..., n_types:], axis=-1) - np.logaddexp.reduce(
            terms[..., :n_types], axis=-1
        )


class CountedPairs:
    """χ² of counts by their likelihood ratio to each known type; attributes as of `MeanPairs`.

    Parameters
    ----------
    probs : (n_types, n_policies, n_cells) float
    weight : (n_types, n_policies) float, optional
        Number of signals that the probabilities count as for a task; without it they are exact.
    """

    def __init__(self, probs: Array, weight: Array | None) -> None:
        self.freedom, self.n_kinds = float(probs.shape[2] - 1), len(probs)
        self._probs = np.ascontiguousarray(probs.transpose(1, 0, 2))
        self._weight = None if weight is None else np.ascontiguousarray(weight.T)

    def misfit(self, counts: Array, policies: Numbers) -> Array:
        """χ² of counts shown of `policies` (...), (..., n_kinds); 0 where nothing is shown."""
        total = np.maximum(counts.sum(axis=-1, keepdims=True), 1)
        best = (counts * np.log(np.maximum(counts, 1) / total)).sum(axis=-1)
        return np.clip(2 * (best[..., None] - self._log_likelihood(counts[..., None, :], policies)), 0, LARGEST)

    def statistic(self, misfit: Array, freedom: Array) -> Array:
        """By how many deviations the least χ² exceeds its degrees of freedom, from sums (..., n_kinds)."""
        return (misfit.min(axis=-1) - freedom) / np.sqrt(2 * np.maximum(freedom, 1))

    def _log_likelihood(self, counts: Array, policies: Numbers) -> Array:
        """log P of sequences with counts (..., 1, n_cells), (..., n_types)."""
        probs = self._probs[policies]
        possible = probs > 0
        if self._weight is None:
            terms = counts * log_of(np.where(possible, probs, 1.0))
            total = 0.0
        else:
            weight = self._weight[policies]
            prior = np.where(possible, weight[..., None] * probs, 1.0)
            terms = gammaln(prior + counts) - gammaln(prior)
            total = gammaln(weight + counts.sum(axis=-1)) - gammaln(weight)
        return np.where(possible, terms, np.where(counts > 0, -LARGEST, 0.0)).sum(axis=-1) - total


def pairs_of(signal: Any, prior: Array) -> MeanPairs | CountedPairs:
    """What tasks are compared with whose signals are outcomes or categories."""
    model: Any = signal.outcomes if isinstance(signal, ReturnSignal) else signal
    if isinstance(model, GaussianOutcomes):
        return MeanPairs(model, prior)
    return CountedPairs(model.probs, weight_of_runs(model))


def means_of_types(model: GaussianOutcomes, prior: Array) -> tuple[Array, Array]:
    """Mean outcomes of the pairs on a task of each type, and what runs and tasks leave in doubt of them.

    Means of few runs scatter more than the true means do, and the largest of them are too large. They are drawn
    towards the mean of all types as far as the scatter of all means tells (James and Stein 1961). The doubt is in
    units of the variance of an outcome.
    """
    moments, centre = model.moments, prior @ model.mean
    error, spread = moments.variance / moments.count, model.spread.least.values[0]
    between = (prior @ (model.mean - centre) ** 2).mean() / max(1 - prior @ prior, 1e-12) - error.mean()
    # Types that differ no more than by the errors, or a single type, do not tell how far they differ.
    share = between / (between + error) if len(prior) > 1 and between > error.mean() else np.ones_like(error)
    return centre + share * (model.mean - centre), share / moments.count + spread


def weight_of_runs(model: Any) -> Array | None:
    """Number of signals of a task that the runs of a counted model count as, (n_types, n_policies); None: exact.

    At the least spread of the tasks of a type.
    """
    law = model.law()
    return law.weight[:, law.spread.values.argmin()].T if law.learns else None
