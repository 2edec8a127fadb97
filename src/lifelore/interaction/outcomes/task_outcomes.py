"""The interface of the outcomes of one task: an outcome model that the task's own outcomes change.

A library's models are known from a finite number of runs. What a task shows tells its type, and also what this
type pays in this task. A model of one task therefore predicts the next outcome given all outcomes of the task so
far, for each type. `TaskNormals` does so for Gaussian and Student's t outcomes, `TaskCounts` for histograms and
categories. Rules score it like any outcome model.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.batch_likelihood import BatchLikelihood, CalledLikelihood, finite_signals
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]


class Predicted(NamedTuple):
    """Log densities of an outcome before it is taken in.

    by_spread : (n_spreads, n_types) float64, given what the task has shown
    fresh : (n_spreads, n_types) float64, in a task that has shown nothing
    """

    by_spread: Array
    fresh: Array


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

    def weights_after(self, by_spread: Array, belief: Array) -> Array:
        """Log probabilities of the spreads after a signal, given the belief (n_types,) before it."""
        if len(self.log_weights) == 1 or (top := by_spread.max()) == -np.inf:
            return self.log_weights
        with np.errstate(divide="ignore"):
            found = self.log_weights + np.log(np.exp(by_spread - top) @ belief)
        found -= found.max()
        return found - np.log(np.exp(found).sum())

    def fade_weights(self, keep: float) -> None:
        """The probabilities where with probability 1 − `keep` the task is a new one."""
        if len(self.log_weights) > 1:
            self.log_weights = np.log(keep * np.exp(self.log_weights) + (1 - keep) * self.spread.weights)

    def restore_weights(self, log_weights: ArrayLike) -> None:
        """Take over log probabilities; InputError where they are not this spread's."""
        found = np.array(log_weights, np.float64)
        if found.shape != self.log_weights.shape or not np.isclose(np.exp(found).sum(), 1):
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

    def predicted(self, policy: int, value: Any) -> Predicted:
        """The log density of `value` by spread and type; InputError or NotFoundError as `log_density`."""
        raise NotImplementedError

    def learn(self, policy: int, value: Any, log_weights: Array | None = None) -> None:
        """Take in an outcome of this task, and the spreads' log probabilities after it."""
        raise NotImplementedError

    def fade(self, keep: float) -> None:
        """Let everything that the task has shown count `keep` of what it did."""
        raise NotImplementedError

    def log_density(self, policy: int, value: float) -> Array:
        """Log density of `value` per type, given what the task has shown, (n_types,)."""
        return mixed(self.predicted(policy, value).by_spread, self.log_weights)

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
