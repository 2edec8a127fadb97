"""The law of a type that is not known: as broad as all types of a library together.

Outcomes: mean and variance of a policy have a normal-inverse-χ² law around the pooled mean of the types, as wide
as the types differ. Cells: a Dirichlet law around the pooled probabilities, whose weight follows from how much the
types differ. An unknown type may differ from the known types where these agree, so every policy is at
least as broad as all policies are on average. What a task shows teaches the law, as it teaches those of known
types.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.counted_law import CountedLaw
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.normal_law import EXACT, NormalLaw
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]

LEAST_SPREAD = 0.1
"""Least spread over types, in deviations of an outcome, for types that agree on all policies."""
UNIFORM = 0.25
"""Share of the uniform distribution in pooled probabilities; more trusts first signs of a new type sooner."""
WEIGHTS = (0.5, 1000.0)
"""Least and largest number of signals that the pooled probabilities count as."""


def unknown_law(library: PolicyLibrary, dtype: str = "f8") -> NormalLaw | CountedLaw:
    """The law of one type with the policies and the signals of `library`.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories.
    """
    signal, prior, spread = library.signal, library.prior, Spread.known(0.0)
    model: Any = signal.outcomes if isinstance(signal, ReturnSignal) else signal
    if isinstance(model, CategorySignal):
        return CountedLaw(broad_counts(model.probs, prior), spread, model.places_of, dtype=dtype)
    if isinstance(model, CountedOutcomes):
        return CountedLaw(broad_counts(model.probs, prior), spread, model.cells.of, model.cells, dtype)
    if isinstance(model, GaussianOutcomes):
        return NormalLaw(broad_moments(model.moments, prior), spread, dtype)
    raise InputError(
        f"novelty is computed from outcomes or categories, got {type(signal).__name__}; build a second library "
        "whose signals are outcomes, and let a detector observe those"
    )


def broad_moments(known: OutcomeMoments, prior: Array) -> OutcomeMoments:
    """The moments of one type from those of the types and the types' prior (n_types,).

    The variances are as well known as those of the known types: only the mean pays shall tell a task from these.
    """
    centre, variance = prior @ known.mean, np.maximum(prior @ known.variance, 1e-300)
    spread = prior @ (known.mean - centre) ** 2
    spread = np.maximum(np.maximum(spread, spread.mean()), LEAST_SPREAD**2 * variance)
    fields = (centre, variance, variance / spread, prior @ np.minimum(known.freedom, EXACT))
    return OutcomeMoments(*(field[None] for field in fields), pooled=known.pooled, shrinkage=known.shrinkage)


def broad_counts(probs: Array, prior: Array) -> Array:
    """The counts of one type, (1, n_policies, n_cells), from probabilities (n_types, n_policies, n_cells)."""
    pooled = np.tensordot(prior, probs, axes=1)
    spread = np.tensordot(prior, (probs - pooled) ** 2, axes=1).sum(axis=1)
    noise = (pooled * (1 - pooled)).sum(axis=1)
    least = 1e-12 * max(float(noise.sum()), 1.0)
    weight = np.minimum(noise / np.maximum(spread, least), noise.sum() / max(float(spread.sum()), least)) - 1
    pooled = (1 - UNIFORM) * pooled + UNIFORM / probs.shape[2]
    return (pooled * np.clip(weight, *WEIGHTS)[:, None])[None]
