"""The interface of the outcomes of one task: an outcome model that the task's own outcomes change.

A library's models are known from a finite number of runs. What a task shows tells its type, and also what this
type pays in this task. A model of one task therefore predicts the next outcome given all outcomes of the task so
far, for each type. `TaskNormals` does so for Gaussian and Student's t outcomes, `TaskCounts` for histograms and
categories. Rules score it like any outcome model.
"""

from functools import cache
from math import exp, inf, log, pi, sqrt
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.array_log import exps, logs, ndtrs
from lifelore.core.compiled.compiler_start import kernel_pays
from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.batch_likelihood import BatchLikelihood, CalledLikelihood, finite_signals
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]

ROOT_2_PI = sqrt(2 * pi)
SLACK = 1e-5
"""Rounding error of probabilities that sum to 1."""
NOTHING = np.empty(0)
"""What the kernels take in place of `log_anew` where types are static."""


class TaskEvidence(NamedTuple):
    """Evidence of an outcome on the types and the spreads.

    log_likelihood : (n_types,) float64
    changed : (n_types,) float64
        Probability that the type has just changed, given that it is now this type and showed the outcome.
    gain : (n_spreads,) float64
        Log likelihoods of the spreads, up to a constant; 0 where there is a single spread.
    """

    log_likelihood: Array
    changed: Array
    gain: Array


class SpreadWeights:
    """Probabilities of the spreads of one task.

    Parameters
    ----------
    spread : Spread

    Attributes
    ----------
    log_weights : (n_spreads,) float64
        Log probabilities of the spreads, given what the task has shown.
    """

    def __init__(self, spread: Spread) -> None:
        self.spread = spread
        self.log_weights: Array = np.log(spread.weights)

    def predicted(self, policy: int, signal: Any, /) -> Array:
        """The log density of a signal given what the task has shown, (n_spreads, n_types).

        Errors are those of `log_density`.
        """
        raise NotImplementedError

    def predicted_anew(self, policy: int, signal: Any, /) -> Array:
        """`predicted` of a task that has shown nothing."""
        raise NotImplementedError

    def evidence(self, policy: int, signal: Any, log_belief: Array, log_anew: Array | None) -> TaskEvidence:
        """The evidence of a signal, before it is taken in; see `evidence_of`."""
        found = self.predicted(policy, signal)
        fresh = found if log_anew is None else self.predicted_anew(policy, signal)
        return evidence_of(found, fresh, self.log_weights, self.spread, log_belief, log_anew)

    def table_rows(self, policy: int, cuts: Any, n_bins: int) -> Array:
        """P(bin | type) of a policy's next signal, (n_types, n_bins)."""
        raise NotImplementedError

    def many_rows(self, policies: list[int], cuts: list[Any], n_bins: int) -> Array:
        """`table_rows` of policies, (n, n_types, n_bins)."""
        return np.stack([self.table_rows(policy, own, n_bins) for policy, own in zip(policies, cuts, strict=True)])

    def weights_after(self, by_spread: Array, belief: Array) -> Array:
        """Log probabilities of the spreads after a signal, given the belief (n_types,) before it."""
        return self.weights_gained(gain_of(by_spread, belief))

    def weights_gained(self, gain: Array) -> Array:
        """Log probabilities of the spreads after a signal of `gain`, see `TaskEvidence`."""
        if len(self.log_weights) == 1:
            return self.log_weights
        # A few numbers: plain Python is faster than NumPy.
        found = [weight + more for weight, more in zip(self.log_weights.tolist(), gain.tolist(), strict=True)]
        if not (top := max(found)) > -inf:
            return self.log_weights
        total = top + log(sum(exp(weight - top) for weight in found))
        return np.array([weight - total for weight in found])

    def fade_weights(self, keep: float) -> None:
        """The probabilities where with probability 1 − `keep` the task is a new one."""
        if len(self.log_weights) > 1:
            pairs = zip(self.log_weights.tolist(), self.spread.weights.tolist(), strict=True)
            found = [keep * exp(weight) + (1 - keep) * first for weight, first in pairs]
            self.log_weights = np.array([log(weight) if weight > 0 else -inf for weight in found])

    def restore_weights(self, log_weights: ArrayLike) -> None:
        """Take over log probabilities; InputError where they are not this spread's."""
        found = np.array(log_weights, np.float64)
        if found.shape != self.log_weights.shape or not abs(float(np.exp(found).sum()) - 1) < SLACK:
            raise InputError(f"a task's state must have {len(self.log_weights)} probabilities of spreads")
        self.log_weights = found


class TaskOutcomes(SpreadWeights):
    """Base of the models of one task."""

    mean: Array

    @property
    def n_types(self) -> int:
        return self.mean.shape[0]

    @property
    def n_policies(self) -> int:
        return self.mean.shape[1]

    def learn(self, policy: int, value: Any, log_weights: Array | None = None) -> None:
        """Take in an outcome of this task, and the spreads' log probabilities after it."""
        raise NotImplementedError

    def fade(self, keep: float) -> None:
        """Let everything that the task has shown count `keep` of what it did."""
        raise NotImplementedError

    def log_density(self, policy: int, value: float) -> Array:
        """Log density of `value` per type, given what the task has shown, (n_types,)."""
        return mixed(self.predicted(policy, value), self.log_weights)

    def log_densities(self, policies: NDArray[np.int64], values: ArrayLike) -> Array:
        """`log_density` of many possible next outcomes, (n,) and (n,) to (n, n_types)."""
        pairs = zip(np.asarray(policies).tolist(), np.asarray(values).tolist(), strict=True)
        return np.array([self.log_density(policy, value) for policy, value in pairs])

    def batch_likelihood(self) -> BatchLikelihood:
        """Log densities of possible next outcomes; none of them is taken in."""
        return CalledLikelihood(self.log_densities, finite_signals)

    def observe(self, type_: int, policy: int, value: float) -> None:
        """A task's model learns by `learn`, from outcomes of a type that is not known."""
        raise InputError("a task's model learns by update; let the library observe outcomes of known types")


def mixed(by_spread: Array, log_weights: Array) -> Array:
    """Log of the mixture over spreads, (n_spreads, n) and (n_spreads,) to (n,)."""
    if len(log_weights) == 1:
        return by_spread[0]
    terms = by_spread + log_weights[:, None]
    top = terms.max(axis=0)
    top = np.where(top > -np.inf, top, 0.0)
    with np.errstate(divide="ignore"):
        return np.log(np.exp(terms - top).sum(axis=0)) + top


def normal_excess(above: Array, variance: Array) -> Array:
    """E[max(X, 0)] of normal X with mean `above` and a variance; 0 where the mean is ten deviations below 0."""
    deviation = np.sqrt(variance)
    z = np.clip(above / np.maximum(deviation, 1e-300), -1e3, 1e3)
    found = np.maximum(deviation * (exps(-0.5 * z * z) / ROOT_2_PI) + above * ndtrs(z), 0.0)
    return np.where((above > 0) | (above * above < 100 * variance), found, 0.0)


def evidence_of(
    by_spread: Array, fresh: Array, log_weights: Array, spread: Spread, log_belief: Array, log_anew: Array | None
) -> TaskEvidence:
    """The evidence of an outcome whose densities are known; compiled where that pays, with the same bits.

    Parameters
    ----------
    by_spread : (n_spreads, n_types) float64
        Log densities of the outcome, given what the task has shown.
    fresh : (n_spreads, n_types) float64
        The same in a task that has shown nothing; not read where types are static.
    log_weights : (n_spreads,) float64
        Log probabilities of the spreads before the outcome.
    spread : Spread
    log_belief : (n_types,) float64
        Before the outcome.
    log_anew : (n_types,) float64, optional
        Log probability that the type has just changed to each type; None where types are static.
    """
    if kernel_pays(8 * by_spread.size):
        n_spreads, n_types = by_spread.shape
        found = TaskEvidence(np.empty(n_types), np.empty(n_types), np.zeros(n_spreads))
        log_first, anew = np.log(spread.weights), NOTHING if log_anew is None else log_anew
        task_kernels().evidence_of(by_spread, fresh, log_weights, log_first, log_belief, anew, *found)
        return found
    terms = by_spread + log_weights[:, None]
    if log_anew is None:
        changed = np.zeros(terms.shape[1])
        top = terms.max(axis=0)
        top = np.where(top > -np.inf, top, 0.0)
        total = _sum_of_rows(exps(terms - top))
    else:
        share = np.full(log_anew.shape, -np.inf)
        np.subtract(log_anew, log_belief, out=share, where=log_anew > -np.inf)
        share = np.minimum(share, 0.0)
        rest = 1.0 - exps(share)
        terms = terms + np.where(rest > 0, logs(np.maximum(rest, 1e-300)), -np.inf)
        anew = fresh + np.log(spread.weights)[:, None] + share
        top = np.maximum(terms.max(axis=0), anew.max(axis=0))
        top = np.where(top > -np.inf, top, 0.0)
        changed = _sum_of_rows(exps(anew - top))
        total = _sum_of_rows(exps(terms - top)) + changed
    possible = total > 0
    log_likelihood = np.where(possible, logs(np.where(possible, total, 1.0)) + top, -np.inf)
    changed = changed / np.where(possible, total, 1.0)
    return TaskEvidence(log_likelihood, changed, gain_of(by_spread, exps(log_belief)))


def gain_of(by_spread: Array, belief: Array) -> Array:
    """Log likelihoods of the spreads up to a constant, given the belief (n_types,) before the outcome."""
    if len(by_spread) == 1:
        return np.zeros(1)
    if kernel_pays(8 * by_spread.size):
        gain = np.empty(len(by_spread))
        task_kernels().gain_of(by_spread, belief, gain)
        return gain
    if (top := by_spread.max()) == -np.inf:
        return np.zeros(len(by_spread))
    # Sums in the order of the kernel's.
    sums = np.add.accumulate(exps(by_spread - top) * belief, axis=1)[:, -1]
    return np.where(sums > 1e-307, logs(np.maximum(sums, 1e-307)), -np.inf)


@cache
def task_kernels() -> ModuleType:
    """The kernels of a single task, imported at their first use, because the import starts Numba."""
    from lifelore.interaction.outcomes import task_kernels as kernels

    return kernels


def _sum_of_rows(values: Array) -> Array:
    total = np.zeros(values.shape[1])
    for row in values:
        total += row
    return total
