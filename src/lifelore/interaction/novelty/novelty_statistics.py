"""Statistics of novelty of one task or many: surprise and shortfall in deviations, and odds of no known type.

    surprise   Σ (−log m(σ) − E) / √V    with E and V its expectation and variance under the mixture m of the types
    shortfall  Σ (E[U] − U) / √V[U]      where the signal is the outcome
    log odds   Σ log q(σ) − log m(σ)     with q the broad law

For tasks of known types with exact models, the terms of both sums have mean 0 and variance 1 (they are martingale
differences), whatever the rule chooses.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.library.broad_law import BroadLaw, broad_law
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.signal_laws import signal_laws
from lifelore.interaction.reuse.explanation import MAX_SURPRISE

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

LARGEST_TERM = 30.0
"""Largest size of a term in deviations, so that a single impossible signal leaves the sums finite."""
LEAST_VARIANCE = 1e-6
"""Least variance of a surprise in nats²; of an outcome, relative to the square of its size."""
SURPRISE_WEIGHT = 0.5
"""Weight of the surprise beside the shortfall; a surprise rises in either direction and tells less."""


class NoveltySums(NamedTuple):
    """Sums over the signals of each of n tasks, changed in place.

    n_signals, surprise, shortfall, log_odds : (n,) float64
    shown : (n, n_policies, width) float64, what the broad law has learnt of each policy
    """

    n_signals: Array
    surprise: Array
    shortfall: Array
    log_odds: Array
    shown: Array


class NoveltyStatistics:
    """Judges signals against what a library's types predict.

    Parameters
    ----------
    library : PolicyLibrary
        Not copied; its models must not change.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories.
    """

    def __init__(self, library: PolicyLibrary) -> None:
        self.library, self.laws = library, signal_laws(library)
        self.broad: BroadLaw = broad_law(library, self.laws)
        # Policy first: a signal reads the row of a policy.
        self._mean = np.ascontiguousarray(library.performance.mean.T)
        self._square = self._mean**2 + np.ascontiguousarray(library.performance.deviation.T) ** 2

    def sums(self, n: int = 1) -> NoveltySums:
        """The sums of `n` tasks before their first signal."""
        shown = np.zeros((n, self.library.n_policies, self.broad.width))
        return NoveltySums(np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), shown)

    def add(
        self,
        sums: NoveltySums,
        belief: Array,
        policies: Numbers,
        signals: Array,
        log_likelihood: Array | None = None,
    ) -> Array:
        """Add a signal of each task to its sums.

        Parameters
        ----------
        belief : (n, n_types) float
            Before the signal.
        policies : (n,) int64
        signals : (n,) float
            As `SignalLaws.numbers` gives them.
        log_likelihood : (n, n_types) float, optional
            log F of the signals, where it is computed already.

        Returns
        -------
        (n,) float64
            The surprise, −log m(σ), at most `MAX_SURPRISE` nats.
        """
        if log_likelihood is None:
            log_likelihood = self.laws.log_likelihoods(policies, signals)
        surprise = np.minimum(-log_mixture(belief, log_likelihood), MAX_SURPRISE)
        expected, variance = self._expected_surprise(belief, policies)
        n_signals, surprises, shortfalls, log_odds, shown = sums
        n_signals += 1
        surprises += _deviations(surprise - expected, np.maximum(variance, LEAST_VARIANCE))
        if self.laws.pays:
            mean = np.einsum("ij,ij->i", belief, self._mean[policies])
            square = mean * mean
            spread = np.einsum("ij,ij->i", belief, self._square[policies]) - square
            shortfall = mean - self.laws.outcomes(signals)
            shortfalls += _deviations(shortfall, np.maximum(spread, LEAST_VARIANCE * (square + 1e-12)))
        every = np.arange(len(policies))
        own = shown[every, policies]
        log_odds += self.broad.log_density(own, policies, signals)
        log_odds += surprise
        self.broad.learn(own, signals)
        shown[every, policies] = own
        return surprise

    def statistic(self, sums: NoveltySums) -> Array:
        """Shortfall and surprise joined, (n,), on the scale of one deviation; surprise alone without outcomes."""
        weight = SURPRISE_WEIGHT if self.laws.pays else 1.0
        return (sums.shortfall + weight * sums.surprise) / np.sqrt(np.maximum(sums.n_signals, 1.0))

    def _expected_surprise(self, belief: Array, policies: Numbers) -> tuple[Array, Array]:
        if len(policies) == 1:
            return self.laws.cells(int(policies[0])).expected_surprise(belief)
        expected, variance = np.empty((2, len(policies)))
        for policy in np.unique(policies).tolist():
            some = policies == policy
            expected[some], variance[some] = self.laws.cells(policy).expected_surprise(belief[some])
        return expected, variance


def log_mixture(belief: Array, log_likelihood: Array) -> Array:
    """log Σ β F of rows (n, n_types); minus infinity where no type explains the signal."""
    top = log_likelihood.max(axis=1)
    if not top.min() > -np.inf:
        top = np.where(top > -np.inf, top, 0.0)
    total = np.einsum("ij,ij->i", belief, np.exp(log_likelihood - top[:, None]))
    if not total.min() > 0:
        # The best types may have no belief, or the signal may be impossible.
        top = np.max(log_likelihood, axis=1, where=belief > 0, initial=-np.inf)
        top = np.where(top > -np.inf, top, 0.0)
        total = (belief * np.exp(np.minimum(log_likelihood - top[:, None], 0.0))).sum(axis=1)
        with np.errstate(divide="ignore"):
            return np.log(total) + top
    return np.log(total) + top


def _deviations(difference: Array, variance: Array) -> Array:
    return np.minimum(np.maximum(difference / np.sqrt(variance), -LARGEST_TERM), LARGEST_TERM)
