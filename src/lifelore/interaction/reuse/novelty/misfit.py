"""The statistic of an alarm: how badly the known types fit tasks, and by how much outcomes fall short.

    misfit     min_τ Σ_π χ²(τ, π), over the d degrees of freedom of the policies that a task has tried
    shortfall  Σ (E[U] − U) / √V[U] over the n signals, under the belief before each, where signals are outcomes
    statistic  (misfit − d) / √(2d) + shortfall / √n

χ² compares what a task has shown of a policy with what the runs of a type say, given what both leave in doubt (n
runs of a pair, spread ρ of the tasks of a type):

    outcomes   k (x̄ − m)² / (v (1 + k (1/n + ρ))) of k outcomes with mean x̄
    cells      2 Σ c log(c / k) − 2 log P(c | τ, π) of counts c, P Dirichlet-multinomial

The misfit sees that no single type fits all policies. The shortfall sees that the policy that seems best is not.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.law import Numbers
from lifelore.interaction.outcomes.log_probability import log_of
from lifelore.interaction.outcomes.special_functions import gammaln
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]

LARGEST = 1e6
"""Largest χ² of a pair, so that impossible signals leave the sums finite."""
LARGEST_TERM = 30.0
"""Largest size of a shortfall in deviations."""


class Misfit:
    """The statistic of tasks, signal by signal.

    Parameters
    ----------
    rows : ReuseAlgorithm
        Of the same tasks, of `unknown_evidence`; `observe` teaches them too.

    Attributes
    ----------
    n_signals, shortfall, freedom : (n_tasks,) float64
    by_type : (n_tasks, n_types) float64
        Σ χ² over the policies that a task has tried.
    """

    def __init__(self, rows: ReuseAlgorithm) -> None:
        self.rows, library = rows, rows.library
        n_tasks, n_types = rows.log_belief.shape
        self.n_signals, self.shortfall, self.freedom = np.zeros((3, n_tasks))
        self.by_type = np.zeros((n_tasks, n_types))
        self._pairs = pairs_of(library.signal)
        self._mean: Array | None = None
        if isinstance(library.signal, ReturnSignal):
            # Policy first: a signal reads the row of a policy.
            self._mean = np.ascontiguousarray(library.performance.mean.T)
            self._square = self._mean**2 + library.performance.deviation.T**2

    def observe(self, tasks: Numbers, policies: Numbers, signals: Any) -> None:
        """Take in a signal of each of `tasks`; errors as for `ReuseAlgorithm.observe`."""
        belief, statistics = self.rows.belief(tasks), self.rows.unknown.shown
        before = self._pairs.misfit(statistics[tasks, policies], policies)
        first = ~statistics[tasks, policies].any(axis=-1)
        self.rows.observe(tasks, policies, signals)
        self.by_type[tasks] += self._pairs.misfit(statistics[tasks, policies], policies) - before
        self.freedom[tasks] += self._pairs.freedom * first
        self.n_signals[tasks] += 1
        if self._mean is not None:
            self.shortfall[tasks] += self._fallen_short(belief, policies, signals)

    def statistic(self, tasks: Numbers) -> Any:
        """The statistic of `tasks` (...), (...) float64; 0 before the first signal."""
        n, freedom = np.maximum(self.n_signals[tasks], 1), np.maximum(self.freedom[tasks], 1)
        misfit = (self.by_type[tasks].min(axis=-1) - self.freedom[tasks]) / np.sqrt(2 * freedom)
        return misfit + self.shortfall[tasks] / np.sqrt(n)

    def _fallen_short(self, belief: Array, policies: Numbers, outcomes: Any) -> Any:
        mean = (belief * self._mean[policies]).sum(axis=-1)  # pyright: ignore[reportOptionalSubscript]
        variance = (belief * self._square[policies]).sum(axis=-1) - mean**2
        deviation = np.sqrt(np.maximum(variance, 1e-6 * (mean**2 + 1e-12)))
        return np.clip((mean - outcomes) / deviation, -LARGEST_TERM, LARGEST_TERM)


class MeanPairs:
    """χ² of mean outcomes; `mean`, `variance` and `doubt` (1/n + ρ) are (n_types, n_policies).

    Attributes
    ----------
    freedom : float
        Degrees of freedom of a policy.
    """

    freedom = 1.0

    def __init__(self, mean: Array, variance: Array, doubt: Any) -> None:
        self._mean, self._variance = np.ascontiguousarray(mean.T), np.ascontiguousarray(variance.T)
        self._doubt = np.ascontiguousarray(np.broadcast_to(doubt, mean.shape).T)

    def misfit(self, moments: Array, policies: Numbers) -> Array:
        """χ² of moments shown of `policies` (...) against each type, (..., n_types); 0 where nothing is shown."""
        count, mean = moments[..., None, 0], moments[..., None, 1]
        variance = self._variance[policies] * (1 + count * self._doubt[policies])
        return np.minimum(count * (mean - self._mean[policies]) ** 2 / variance, LARGEST)


class CountedPairs:
    """χ² of counts by their likelihood ratio; attributes as of `MeanPairs`.

    Parameters
    ----------
    probs : (n_types, n_policies, n_cells) float
    weight : (n_types, n_policies) float, optional
        Number of signals that the probabilities count as for a task; without it they are exact.
    """

    def __init__(self, probs: Array, weight: Array | None) -> None:
        self.freedom = float(probs.shape[2] - 1)
        self._probs = np.ascontiguousarray(probs.transpose(1, 0, 2))
        self._weight = None if weight is None else np.ascontiguousarray(weight.T)

    def misfit(self, counts: Array, policies: Numbers) -> Array:
        """χ² of counts shown of `policies` (...) against each type, (..., n_types); 0 where nothing is shown."""
        total = np.maximum(counts.sum(axis=-1, keepdims=True), 1)
        best = (counts * np.log(np.maximum(counts, 1) / total)).sum(axis=-1)
        return np.clip(2 * (best[..., None] - self._log_likelihood(counts[..., None, :], policies)), 0, LARGEST)

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


def pairs_of(signal: Any) -> MeanPairs | CountedPairs:
    """χ² against the runs of a signal model whose signals are outcomes or categories."""
    model: Any = signal.outcomes if isinstance(signal, ReturnSignal) else signal
    if isinstance(model, GaussianOutcomes):
        doubt = 1 / model.moments.count + model.spread.least.values[0]
        return MeanPairs(model.moments.mean, model.moments.variance, doubt)
    return CountedPairs(model.probs, weight_of_runs(model))


def weight_of_runs(model: Any) -> Array | None:
    """Number of signals of a task that the runs of a counted model count as, (n_types, n_policies); None: exact.

    At the least spread of the tasks of a type.
    """
    law = model.law()
    return law.weight[:, law.spread.values.argmin()].T if law.learns else None
