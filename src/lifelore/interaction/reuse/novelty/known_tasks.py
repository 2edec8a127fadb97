"""Simulated tasks of known types: the type is drawn from the prior, its true parameters from what the runs say.

Where a model is exact, a task of a type has the model's own distribution. Where it was learnt, mean and variance
of each pair are drawn from their law (normal-inverse-χ², Dirichlet) at the least spread of the tasks of a type:
tasks then differ from the model as much as real tasks do.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.normal_law import EXACT
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.reuse.novelty.misfit import means_of_types, weight_of_runs
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


Tasks = Callable[[Numbers], Any]
"""The next signal of each of n tasks under its policy, (n,), as the library's signal model takes it."""


def normal_tasks(mean: Array, deviation: Array, generator: np.random.Generator) -> Tasks:
    """Tasks with normal outcomes of `mean` and `deviation`, (n, n_policies) each."""

    def outcomes(policies: Numbers) -> Array:
        at = np.arange(len(policies)), policies
        return mean[at] + deviation[at] * generator.standard_normal(len(policies))

    return outcomes


def counted_tasks(probs: Array, generator: np.random.Generator, signals_of: Callable[[Numbers], Any]) -> Tasks:
    """Tasks with cells of probabilities `probs` (n, n_policies, n_cells).

    Parameters
    ----------
    signals_of : callable
        Numbers of cells (n,) to signals.
    """
    cumulative = probs.cumsum(axis=2)

    def signals(policies: Numbers) -> Any:
        rows = cumulative[np.arange(len(policies)), policies]
        level = generator.random(len(rows)) * rows[:, -1]
        return signals_of((rows <= level[:, None]).sum(axis=1))

    return signals


def known_tasks(library: PolicyLibrary, n: int, generator: np.random.Generator) -> Tasks:
    """`n` tasks of the library's types.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories.
    """
    types = generator.choice(library.n_types, n, p=library.prior)
    signal = library.signal
    model: Any = signal.outcomes if isinstance(signal, ReturnSignal) else None
    if isinstance(model, GaussianOutcomes):
        return normal_tasks(*drawn_moments(model, types, library.prior, generator), generator)
    if isinstance(model, CountedOutcomes):
        probs = drawn_probs(model, types, generator)
        return counted_tasks(probs, generator, partial(model.cells.sample, generator))
    if isinstance(signal, CategorySignal):
        names = signal.categories
        named = np.arange(signal.n_categories) if names is None else np.fromiter(names, object, len(names))
        return counted_tasks(drawn_probs(signal, types, generator), generator, lambda cells: named[cells])
    raise InputError(f"known tasks have outcomes or categories as signals, got {type(signal).__name__}")


def drawn_moments(
    model: GaussianOutcomes, types: Numbers, prior: Array, generator: np.random.Generator
) -> tuple[Array, Array]:
    """Mean and deviation of each policy on tasks of `types` (n,), drawn from their law, (n, n_policies) each."""
    mean, doubt = (array[types] for array in means_of_types(model, prior))
    variance, freedom = (array[types] for array in posterior_variance(model.moments))
    freedom = np.minimum(freedom, EXACT)
    drawn = np.maximum(2 * generator.standard_gamma(0.5 * freedom), 1e-12)
    deviation = np.sqrt(variance * (freedom / drawn))
    return mean + deviation * np.sqrt(doubt) * generator.standard_normal(mean.shape), deviation


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
    from scipy.optimize import brentq
    from scipy.special import digamma, polygamma

    log_ratio = np.log(variance) - digamma(freedom / 2) + np.log(freedom / 2)
    excess = float(log_ratio.var(ddof=1) - polygamma(1, freedom / 2).mean()) if len(variance) > 1 else 0.0
    if excess <= 0:
        return float((freedom * variance).sum() / freedom.sum()), np.inf
    # ψ′(half) is the excess; 1 / x² < ψ′(x) < 1 / x + 1 / x².
    half: Any = brentq(lambda x: float(polygamma(1, x)) - excess, excess**-0.5, 1 / excess + 1, xtol=1e-300)
    return float(np.exp(log_ratio.mean() + digamma(half) - np.log(half))), 2 * half


def drawn_probs(model: Any, types: Numbers, generator: np.random.Generator) -> Array:
    """Probabilities of cells on tasks of `types` (n,), drawn from the law of a model, (n, n_policies, n_cells)."""
    probs, weight = model.probs[types], weight_of_runs(model)
    if weight is None:
        return probs
    counts = weight[types][..., None] * probs
    # Gammas of tiny shapes may all round to 0; a cell without counts stays impossible.
    drawn = generator.standard_gamma(counts) + 1e-300 * counts
    return drawn / drawn.sum(axis=-1, keepdims=True)
