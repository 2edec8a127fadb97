"""A library of a single type that is as broad as all types of a library together: a type that is not known.

Outcomes: mean and variance of a policy have a normal-inverse-χ² law around the pooled mean of the types, as wide
as the types differ. Categories: a Dirichlet law around the pooled probabilities, whose weight follows from how
much the types differ. An unknown type may differ from the known types where these agree, so every policy is at
least as broad as all policies are on average. What a task shows teaches the laws, as it teaches those of known
types.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]

FREEDOM = 5.0
"""Degrees of freedom of the variance: the number of outcomes that the types' mean variance counts as."""
LEAST_SPREAD = 0.1
"""Least spread over types, in deviations of an outcome, for types that agree on all policies."""
UNIFORM = 0.25
"""Share of the uniform distribution in pooled probabilities; more trusts first signs of a new type sooner."""
WEIGHTS = (0.5, 1000.0)
"""Least and largest number of signals that the pooled probabilities count as."""


def broad_library(library: PolicyLibrary) -> PolicyLibrary:
    """The library of one type with the policies and the signals of `library`.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories.
    """
    signal, prior = library.signal, library.prior
    if isinstance(signal, CategorySignal):
        counts = broad_counts(signal.probs, prior)
        total = counts.sum(axis=-1)
        returns = GaussianOutcomes(np.zeros((1, library.n_policies)), 1.0)
        return PolicyLibrary(returns, CategorySignal(counts / total[..., None], signal.categories, total))
    model: Any = signal.outcomes if isinstance(signal, ReturnSignal) else None
    if isinstance(model, CategoricalOutcomes):
        outcomes: Any = CategoricalOutcomes.of(model.cells, broad_counts(model.probs, prior), 0.0)
        return PolicyLibrary(outcomes)
    if isinstance(model, GaussianOutcomes | HistogramOutcomes):
        return PolicyLibrary(GaussianOutcomes.of(broad_moments(model.mean, model.deviation, prior)))
    raise InputError(
        f"novelty is computed from outcomes or categories, got {type(signal).__name__}; build a second library "
        "whose signals are outcomes, and let a detector observe those"
    )


def broad_moments(mean: Array, deviation: Array, prior: Array) -> OutcomeMoments:
    """The moments of one type from means and deviations (n_types, n_policies) and the types' prior (n_types,)."""
    centre, variance = prior @ mean, np.maximum(prior @ deviation**2, 1e-300)
    spread = prior @ (mean - centre) ** 2
    spread = np.maximum(np.maximum(spread, spread.mean()), LEAST_SPREAD**2 * variance)
    fields = (centre, variance, variance / spread, np.full_like(centre, FREEDOM))
    return OutcomeMoments(*(field[None] for field in fields), pooled=float(variance.mean()), shrinkage=FREEDOM)


def broad_counts(probs: Array, prior: Array) -> Array:
    """The counts of one type, (1, n_policies, n_cells), from probabilities (n_types, n_policies, n_cells)."""
    pooled = np.tensordot(prior, probs, axes=1)
    spread = np.tensordot(prior, (probs - pooled) ** 2, axes=1).sum(axis=1)
    noise = (pooled * (1 - pooled)).sum(axis=1)
    least = 1e-12 * max(float(noise.sum()), 1.0)
    weight = np.minimum(noise / np.maximum(spread, least), noise.sum() / max(float(spread.sum()), least)) - 1
    pooled = (1 - UNIFORM) * pooled + UNIFORM / probs.shape[2]
    return (pooled * np.clip(weight, *WEIGHTS)[:, None])[None]
