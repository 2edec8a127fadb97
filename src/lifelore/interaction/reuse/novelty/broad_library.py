"""A library of a single type that is as broad as all types of a library together: a type that is not known.

Outcomes: mean and variance of a policy have a normal-inverse-χ² law around the pooled mean of the types, as wide
as the types differ. Categories: a Dirichlet law around the pooled probabilities, whose weight follows from how
much the types differ. An unknown type may differ from the known types where these agree, so every policy is at
least as broad as all policies are on average. What a task shows teaches the laws, as it teaches those of known
types.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.moment_outcomes import MomentOutcomes
from lifelore.interaction.outcomes.outcome_moments import OF_PAIRS, OutcomeMoments
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
    if isinstance(model, MomentOutcomes | HistogramOutcomes):
        return PolicyLibrary(GaussianOutcomes.of(broad_moments(model.mean, model.deviation, prior)))
    raise InputError(
        f"novelty is computed from outcomes or categories, got {type(signal).__name__}; build a second library "
        "whose signals are outcomes, and let a detector observe those"
    )


def with_unknown_type(library: PolicyLibrary, mass: float = 0.2) -> PolicyLibrary:
    """A library with an additional type "unknown" that is as broad as all types together.

    An agent then learns the pays of a user whom no type fits, policy by policy; its belief in the last type is the
    probability that no known type fits. Choose by ``InformationDirected(trials=True)``, so that policies are tried
    on such users. Models must be uncertain, as they are by default.

    Parameters
    ----------
    mass : float
        Prior probability of the additional type, in (0, 1).

    Raises
    ------
    InputError
        `mass` lies outside its range, or signals are not outcomes with means and variances.

    Examples
    --------
    >>> from lifelore import BayesianPolicyReuse
    >>> from lifelore.interaction import InformationDirected
    >>> random = np.random.default_rng(0)
    >>> library = PolicyLibrary.from_samples(random.normal([[[9.0], [5.0]], [[4.0], [8.0]]], 1.0, (2, 2, 10)))
    >>> agent = BayesianPolicyReuse(with_unknown_type(library), InformationDirected(trials=True))
    >>> for _ in range(5):  # no known type is bad with both
    ...     agent.update(0, 4.0)
    ...     agent.update(1, 4.0)
    >>> agent.belief.round(2).tolist()
    [0.05, 0.14, 0.82]
    """
    if not 0 < mass < 1:
        raise InputError(f"mass must lie in (0, 1), got {mass}")
    model = library.performance
    if not (isinstance(model, MomentOutcomes) and isinstance(library.signal, ReturnSignal)):
        raise InputError(
            f"an unknown type needs outcomes as signals, with means and variances, got {type(model).__name__} and "
            f"{type(library.signal).__name__}; use a NoveltyDetector"
        )
    known, broad = model.moments, broad_moments(model.mean, model.deviation, library.prior)
    pairs = {name: np.concatenate([getattr(known, name), getattr(broad, name)]) for name in OF_PAIRS}
    joined = type(model).of(replace(known, spread=model.spread, **pairs))
    prior = np.append((1 - mass) * library.prior, mass)
    types = (*library.types, "unknown")
    return PolicyLibrary(joined, types=types, policies=library.policies, prior=prior)


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
