"""Types of users in each context: outcomes of a context's users, shrunk towards those of the type everywhere.

A library of types becomes one with a type for each context and type. Of each policy,

    mean = m₀ + s (m − m₀),    s = n ρ / (n ρ + 1)

where the outcomes of the context's n users of the type have the mean m, and m₀ is the type's mean everywhere.
ρ is the variance of contexts' means in units of the variance of users' means, by analysis of variance, so that
contexts that do not differ all get m₀: empirical Bayes as in Efron and Morris (1975). The mean is as sure as that
of N outcomes, 1 / N = ρ / (n ρ + 1) + (1 − s)² / N₀, with N₀ outcomes behind m₀.

Differences between contexts are no noise: contexts move the means, and variances, or covariance and noise of
jointly normal outcomes, are fitted to outcomes less these moves.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.fitting.library_from_log import Fitted, TypedRows, library_of
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.joint_normal_outcomes import JointNormalOutcomes
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows
from lifelore.interaction.outcomes.spread import VarianceAnalysis, spread_between, variance_analysis

Array = NDArray[np.float64]

CONTEXT_USERS = 5.0
"""Users of everybody's prior that are mixed into each context's."""
FEWEST_USERS = 10
"""Number of users below which a context has no types of its own; its users start with everybody's prior."""
CHANCE = 0.01
"""Probability of outcomes that differ as much between equal contexts, below which contexts differ."""
MOST_CONTEXTS, MOST_PAIRS = 20, 4000
"""Largest number of contexts with types of their own, those with most users, and of pairs of such a type and a
policy; more cost time in each decision."""


def priors_by_context(log: ReuseLog, fitted: Fitted) -> dict[str, Array]:
    """Prior over types (n_types,) in each context of the log, from its users and a few of everybody's."""
    users, types = fitted.typed.users(log)
    places, prior = log.context_of_user[users], fitted.library.prior
    counts = np.zeros((len(log.context.names), len(prior)))
    np.add.at(counts, (places[places >= 0], types[places >= 0]), 1.0)
    rows = CONTEXT_USERS * prior + counts
    rows /= rows.sum(axis=1, keepdims=True)
    return {name: row for name, row in zip(log.context.names, rows, strict=True) if name}


def own_contexts(log: ReuseLog, n_types: int, n_policies: int) -> list[int]:
    """Places in ``log.context.names`` of the contexts that get types of their own, by name; several, or none."""
    known = log.context_of_user[log.context_of_user >= 0]
    users = np.bincount(known, minlength=len(log.context.names))
    most = min(MOST_CONTEXTS, MOST_PAIRS // (n_types * n_policies))
    found = [place for place in np.argsort(-users, kind="stable")[:most].tolist() if users[place] >= FEWEST_USERS]
    return sorted(found) if len(found) > 1 else []


def by_context(log: ReuseLog, typed: TypedRows, model: str) -> Fitted:
    """The library of a log with types by context; that of the types where fewer than two contexts can have some.

    Parameters
    ----------
    typed : TypedRows
        Every row of the log; names of the types.
    model : str
        As for `library_of`; ``joint-normal`` for a single type.
    """
    wide = library_of(log, typed, "gaussian" if model == JointNormalOutcomes.kind else model).library
    contexts = own_contexts(log, wide.n_types, wide.n_policies)
    if not contexts:
        return library_of(log, typed, model)
    parted = _parted(log, typed, contexts)
    rows, at = _rows(log, parted, wide)
    users = log.user.codes[at]
    means = user_means(rows, users)
    found = variance_of_contexts(means, wide.n_types)
    performance: Any = shrunk(wide.performance, rows, means.sums(), found.spread if found else 0.0)
    if not isinstance(performance, CategoricalOutcomes):
        moves, outcomes = (
            performance.mean - np.tile(wide.performance.mean, (parted.contexts, 1)),
            log.outcomes.copy(),
        )
        outcomes[at] -= moves[rows.types, rows.policies]
        still = library_of(replace(log, outcomes=outcomes), typed, model).library.performance
        performance = _moved(still, performance, moves)
    if model != JointNormalOutcomes.kind:
        within = spread_between(rows.pair, users, rows.values)
        performance.spread = wide.performance.spread if within is None else within  # pyright: ignore
    prior = 1.0 + np.bincount(parted.users(log)[1], minlength=len(parted.names))
    library = PolicyLibrary(performance, None, parted.names, wide.policies, prior / prior.sum())  # pyright: ignore
    return Fitted(library, parted, rows.sums())


def contexts_differ(log: ReuseLog) -> bool:
    """Whether outcomes of policies differ between contexts beyond chance; False where there are too few users."""
    contexts = own_contexts(log, 1, len(log.policy.names))
    if not contexts:
        return False
    every: NDArray[np.int64] = np.arange(len(log))
    parted = _parted(log, TypedRows(every, np.zeros_like(every), ("everybody",)), contexts)
    rows = OutcomeRows(parted.types, log.policy.codes[parted.rows], log.outcomes[parted.rows],
                       (len(contexts), len(log.policy.names)))  # fmt: skip
    found = variance_of_contexts(user_means(rows, log.user.codes[parted.rows]), 1)
    return found is not None and found.chance < CHANCE


def user_means(rows: OutcomeRows, users: NDArray[np.int64]) -> OutcomeRows:
    """The mean outcome of each user with each policy, as rows: users are independent, their outcomes are not."""
    pairs, of_group = np.unique(users * (rows.pair.max() + 1) + rows.pair, return_inverse=True)
    pair = pairs % (rows.pair.max() + 1)
    weights = np.ones(len(users)) if rows.weights is None else rows.weights
    values = np.bincount(of_group, weights * rows.values) / np.bincount(of_group, weights)
    return OutcomeRows(pair // rows.shape[1], pair % rows.shape[1], values, rows.shape)


def variance_of_contexts(means: OutcomeRows, n_types: int) -> VarianceAnalysis | None:
    """The analysis of variance of users' means between contexts; None where contexts cannot be compared.

    Parameters
    ----------
    means : OutcomeRows
        Of users; types are numbered context by context, `n_types` in each.
    """
    pairs = means.types % n_types * means.shape[1] + means.policies
    return variance_analysis(pairs, means.types // n_types, means.values)


def shrunk(wide: Any, rows: OutcomeRows, users: Array, ratio: float) -> Any:
    """The outcome model of every context and type, by the outcomes of each and those of the type everywhere.

    Parameters
    ----------
    wide : CategoricalOutcomes, GaussianOutcomes or StudentTOutcomes
        Of the types everywhere, learnt from a finite number of outcomes.
    rows : OutcomeRows
        Types are numbered context by context.
    users : (n_contexts n_types, n_policies) float64
        n, the number of users behind the outcomes of each pair.
    ratio : float
        ρ, at least 0.
    """
    everywhere = wide.take(np.arange(rows.shape[0]) % wide.n_types)
    share, number = users * ratio / (users * ratio + 1), np.maximum(rows.sums(), 1e-300)
    unsure = ratio / (users * ratio + 1)
    if isinstance(wide, CategoricalOutcomes):
        seen = np.stack([rows.sums((rows.values == value).astype(float)) for value in wide.values], axis=2)
        probs = everywhere.probs + share[..., None] * (seen / number[..., None] - everywhere.probs)
        count = 1 / (unsure + (1 - share) ** 2 / everywhere.counts.sum(axis=2))
        return CategoricalOutcomes.of(wide.cells, probs * count[..., None], wide.pseudo_count)
    moments = everywhere.moments
    mean = moments.mean + share * (rows.sums(rows.values) / number - moments.mean)
    count = 1 / (unsure + (1 - share) ** 2 / moments.count)
    return type(wide).of(replace(moments, mean=mean, count=count))


def _parted(log: ReuseLog, typed: TypedRows, contexts: list[int]) -> TypedRows:
    """The rows of users of some contexts, with types numbered context by context."""
    place = np.full(len(log.context.names) + 1, -1)
    place[contexts] = np.arange(len(contexts))
    of_row = place[log.context_of_user[log.user.codes[typed.rows]]]
    known, n_types = of_row >= 0, len(typed.names)
    words = [log.context.names[context] for context in contexts]
    names = [word if n_types == 1 else f"{name}, {word}" for word in words for name in typed.names]
    types = of_row[known] * n_types + typed.types[known]
    return TypedRows(typed.rows[known], types, tuple(names), typed.found, len(contexts))


def _rows(log: ReuseLog, parted: TypedRows, wide: PolicyLibrary) -> tuple[OutcomeRows, NDArray[np.int64]]:
    """Rows of outcomes of a weight above 0, policies numbered as in the library, and their places in the log."""
    weights = None if log.weights is None else log.weights[parted.rows]
    used = np.ones(len(parted.rows), bool) if weights is None else weights > 0
    at = parted.rows[used]
    numbers = {policy: number for number, policy in enumerate(wide.policies)}
    of_policy = np.array([numbers.get(policy, -1) for policy in log.policy.names])[log.policy.codes[at]]
    shape = len(parted.names), wide.n_policies
    rows = OutcomeRows(parted.types[used], of_policy, log.outcomes[at], shape)
    return rows if weights is None else rows.with_weights(weights[used]), at


def _moved(still: Any, shrunk: Any, moves: Array) -> Any:
    """The model with the means of contexts, and the noise of `still`, of outcomes less the contexts' `moves`."""
    if isinstance(still, JointNormalOutcomes):
        return JointNormalOutcomes(still.mean + moves, still.covariance, still.noise)
    variance = np.tile(still.moments.variance, (len(moves) // still.n_types, 1))
    return type(still).of(replace(shrunk.moments, variance=variance, pooled=still.moments.pooled))
