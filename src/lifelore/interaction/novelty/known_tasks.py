"""Simulated tasks of known types: the type is drawn from the prior, its true parameters from what the runs say.

Where a model is exact, a task of a type has the model's own distribution. Where it was learnt, mean and variance
of each pair are drawn from their posterior distribution (normal-inverse-χ², Dirichlet): tasks then differ from the
model as much as real tasks do.
"""

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.moment_outcomes import MomentOutcomes
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


class Tasks(Protocol):
    """Tasks whose signals a rule may ask for."""

    def signals(self, policies: Numbers) -> Array:
        """The next signal of each task under its policy (n,): outcomes, or category numbers."""
        ...


class NormalTasks:
    """Tasks with normal outcomes of `mean` and `deviation`, (n, n_policies) each."""

    def __init__(self, mean: Array, deviation: Array, generator: np.random.Generator) -> None:
        self.mean, self.deviation, self.generator = mean, deviation, generator
        self._every = np.arange(len(mean))

    def signals(self, policies: Numbers) -> Array:
        """Outcomes."""
        noise = self.generator.standard_normal(len(policies))
        return self.mean[self._every, policies] + self.deviation[self._every, policies] * noise


class CategoryTasks:
    """Tasks with cells of probabilities `probs` (n, n_policies, n_cells).

    Parameters
    ----------
    values : (n_cells,) float, optional
        The outcome of a cell; without it signals are the cells' numbers.
    edges : (n_cells + 1,) float, optional
        Edges of bins, in which outcomes are uniform.
    """

    def __init__(
        self,
        probs: Array,
        generator: np.random.Generator,
        values: Array | None = None,
        edges: Array | None = None,
    ) -> None:
        self.cumulative, self.generator = probs.cumsum(axis=2), generator
        self.values, self.edges = values, edges
        self._every = np.arange(len(probs))

    def signals(self, policies: Numbers) -> Array:
        """Outcomes, or category numbers."""
        rows = self.cumulative[self._every, policies]
        level = self.generator.random(len(rows)) * rows[:, -1]
        cells = (rows <= level[:, None]).sum(axis=1)
        if self.edges is not None:
            return self.generator.uniform(self.edges[cells], self.edges[cells + 1])
        return cells.astype(np.float64) if self.values is None else self.values[cells]


def known_tasks(
    library: PolicyLibrary, n: int, generator: np.random.Generator, signal_count: ArrayLike | None = None
) -> Tasks:
    """`n` tasks of the library's types.

    Parameters
    ----------
    signal_count : float or (n_types, n_policies) float, optional
        Number of signals behind each row of a `CategorySignal`, pseudo-counts included; exact without it.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories.
    """
    types = generator.choice(library.n_types, n, p=library.prior)
    signal = library.signal
    if isinstance(signal, CategorySignal):
        count = getattr(signal, "totals", None) if signal_count is None else signal_count
        return CategoryTasks(_category_probs(signal.probs[types], count, types, generator), generator)
    model = signal.outcomes if isinstance(signal, ReturnSignal) else None
    if isinstance(model, MomentOutcomes):
        return NormalTasks(*drawn_moments(model.moments, types, generator), generator)
    if isinstance(model, CategoricalOutcomes | HistogramOutcomes):
        probs = model.probs[types]
        if not model.exact:
            probs = _dirichlet(model.counts.transpose(1, 0, 2)[types], generator)
        cells = {"values": model.values} if isinstance(model, CategoricalOutcomes) else {"edges": model.edges}
        return CategoryTasks(probs, generator, **cells)
    raise InputError(f"known tasks have outcomes or categories as signals, got {type(signal).__name__}")


def drawn_moments(moments: OutcomeMoments, types: Numbers, generator: np.random.Generator) -> tuple[Array, Array]:
    """Mean and deviation of each policy on tasks of `types` (n,), drawn from their posterior, (n, n_policies)."""
    variance, freedom = (array[types] for array in posterior_variance(moments))
    finite = np.isfinite(freedom)
    drawn = 2 * generator.standard_gamma(0.5 * np.where(finite, freedom, 1.0))
    variance = np.where(finite, variance * freedom / np.maximum(drawn, 1e-12), variance)
    error = np.sqrt(variance / moments.count[types])
    return moments.mean[types] + error * generator.standard_normal(error.shape), np.sqrt(variance)


def posterior_variance(moments: OutcomeMoments) -> tuple[Array, Array]:
    """Location and degrees of freedom of each pair's variance, (n_types, n_policies); infinite where exact.

    The prior of the variances is fitted to all pairs (Smyth 2004): where sample variances differ no more than
    chance explains, all pairs have the pooled variance. The fixed shrinkage of `OutcomeMoments` would draw too
    large variances there, and thresholds would be too high.
    """
    # Degrees of freedom of the samples alone: given numbers have no shrinkage in them.
    given = moments.freedom == moments.count
    freedom = np.where(given, moments.count, moments.count - 1)
    learnt = np.isfinite(freedom) & (freedom > 0)
    if not learnt.any():
        return moments.variance, moments.freedom
    squares = np.where(
        given, freedom * moments.variance, moments.freedom * moments.variance - moments.shrinkage * moments.pooled
    )
    own = np.maximum(squares[learnt] / freedom[learnt], 1e-12 * moments.pooled)
    centre, prior_freedom = _fitted_prior(own, freedom[learnt])
    location, total = moments.variance.copy(), moments.freedom.copy()
    if np.isinf(prior_freedom):
        location[learnt], total[learnt] = centre, np.inf
    else:
        total[learnt] = prior_freedom + freedom[learnt]
        location[learnt] = (prior_freedom * centre + squares[learnt]) / total[learnt]
    return location, total


def _fitted_prior(variance: Array, freedom: Array) -> tuple[float, float]:
    """Location and degrees of freedom of a scaled inverse χ² prior, fitted to logs of sample variances (n,)."""
    from scipy.special import digamma, polygamma

    log_ratio = np.log(variance) - digamma(freedom / 2) + np.log(freedom / 2)
    excess = float(log_ratio.var(ddof=1) - polygamma(1, freedom / 2).mean()) if len(variance) > 1 else 0.0
    if excess <= 0:
        return float((freedom * variance).sum() / freedom.sum()), np.inf
    half = _inverse_trigamma(excess)
    return float(np.exp(log_ratio.mean() + digamma(half) - np.log(half))), 2 * half


def _inverse_trigamma(value: float) -> float:
    """The x > 0 with ψ′(x) = value, by Newton's method on 1 / ψ′."""
    from scipy.special import polygamma

    x = 0.5 + 1 / value
    for _ in range(50):
        slope = float(polygamma(1, x))
        step = slope * (1 - slope / value) / float(polygamma(2, x))
        x += step
        if -step / x < 1e-10:
            break
    return x


def _category_probs(
    probs: Array, count: ArrayLike | None, types: Numbers, generator: np.random.Generator
) -> Array:
    if count is None:
        return probs
    count = np.asarray(count, np.float64)
    if not ((count > 0) & np.isfinite(count)).all():
        raise InputError("signal_count must be positive and finite; leave it out where probabilities are exact")
    return _dirichlet(probs * (count[types] if count.ndim else count.reshape(1, 1))[..., None], generator)


def _dirichlet(counts: Array, generator: np.random.Generator) -> Array:
    # Gammas of tiny shapes may all round to 0; a cell without counts stays impossible.
    drawn = generator.standard_gamma(counts) + 1e-300 * counts
    return drawn / drawn.sum(axis=-1, keepdims=True)
