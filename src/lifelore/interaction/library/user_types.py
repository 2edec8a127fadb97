"""Types of users found by their outcomes: a mixture of outcome models of a given number of types.

Each user has a hidden type. Given the type, outcomes are independent, with a distribution for each pair of type
and policy. Policy reuse has the same model, so users need not have met every policy, and users with many outcomes
have more weight. The mixture is fitted by expectation–maximisation from the seeds of k-means++ and from random
starts.

The families are ``gaussian``, with a deviation for each policy shared by all types, and ``categorical``; see
`outcome_families`.

Thesis: §4.3.3 assumes a given clustering; §4.7.2 names clustering as a way to choose types.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.log_probability import normalised
from lifelore.interaction.outcomes.outcome_families import FAMILIES, OutcomeFamily
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows

Array = NDArray[np.float64]

STARTS = 6
"""Number of starts for each number of types, half of them k-means++; more cost time and may fit better."""
FIRST, STEPS, ENOUGH = 15, 300, 1e-7
"""Number of steps of every start, largest number of more steps of the best start (Biernacki et al. 2003), and the
relative gain in log likelihood below which they end."""
SAMPLED_USERS = 5_000
"""Of more users, a random sample of so many gives the start for all; more cost time."""


@dataclass(frozen=True, eq=False)
class UserTypes:
    """Types found among users, the most common type first.

    Parameters
    ----------
    probs : (n_users, n_types) float64
        P(type | the user's outcomes); rows sum to 1.
    weights : (n_types,) float64
        Share of users, descending.
    """

    probs: Array
    weights: Array

    @property
    def labels(self) -> NDArray[np.int64]:
        """Each user's most probable type, (n_users,)."""
        return self.probs.argmax(axis=1)

    @property
    def n_types(self) -> int:
        """Number of types."""
        return len(self.weights)


def user_types(
    rows: OutcomeRows, generator: np.random.Generator, n_types: int, *, family: str = "gaussian"
) -> UserTypes:
    """Group users by their outcomes.

    Parameters
    ----------
    rows : OutcomeRows
        With numbers of users in place of types; every user and every policy has a row.
    generator : numpy generator
        For the starts.
    n_types : int
        Largest number of types; a type that is no user's most probable type is left out.
    family : {"gaussian", "categorical"}

    Raises
    ------
    InputError
        A user or policy has no row, there are more types than users, or there is no such family.
    """
    if family not in FAMILIES:
        raise InputError(f"family must be one of {', '.join(FAMILIES)}, got {family!r}")
    made = FAMILIES[family](_checked(rows))
    n_users = rows.shape[0]
    if not 1 <= n_types <= n_users:
        raise InputError(f"n_types must lie between 1 and the {n_users} users, got {n_types}")
    if n_users > SAMPLED_USERS:
        return _named(_of_sample(made, rows, generator, n_types, family))
    starts = (_maximised(made, shares, FIRST) for shares in _starts(rows, n_types, generator))
    return _named(_maximised(made, max(starts, key=lambda fit: fit[1])[0], STEPS)[0])


def _of_sample(
    made: OutcomeFamily, rows: OutcomeRows, generator: np.random.Generator, n_types: int, family: str
) -> Array:
    """The types of a sample of users, then fitted to all users from there."""
    sample = np.sort(generator.choice(rows.shape[0], SAMPLED_USERS, replace=False))
    chosen = np.isin(rows.types, sample)
    # A policy that the sample never met has no place in it.
    policies, of_policy = np.unique(rows.policies[chosen], return_inverse=True)
    shape = len(sample), len(policies)
    part = OutcomeRows(np.searchsorted(sample, rows.types[chosen]), of_policy, rows.values[chosen], shape)
    found = user_types(part, generator, n_types, family=family)
    shares = np.zeros((rows.shape[0], found.n_types))
    shares[sample] = found.probs
    return _maximised(made, _expected(made, shares, found.weights)[0], STEPS)[0]


def _starts(rows: OutcomeRows, size: int, generator: np.random.Generator) -> Iterator[Array]:
    """Shares (n_users, size) to start from."""
    n_users = rows.shape[0]
    if size == 1 or size == n_users:
        yield np.eye(size)[np.arange(n_users) % size]
        return
    profiles = _profiles(rows)
    for start in range(STARTS):
        drawn = generator.integers(size, size=n_users)
        near = _near_seeds(profiles, size, generator) if start % 2 == 0 else drawn
        # No user is certain at the start, so that no type starts empty.
        yield 0.9 * np.eye(size)[near] + 0.1 / size


def _profiles(rows: OutcomeRows) -> Array:
    """Mean outcome of each user with each policy in deviations of that policy, 0 without outcomes."""
    number, total = rows.sums(), rows.sums(rows.values)
    mean = np.where(number > 0, total / np.maximum(number, 1), np.nan)
    away = mean - np.nanmean(mean, axis=0)
    spread = np.sqrt(np.nanmean(away**2, axis=0))
    return np.nan_to_num(away / np.where(spread > 0, spread, 1.0))


def _near_seeds(profiles: Array, size: int, generator: np.random.Generator) -> NDArray[np.int64]:
    """The nearest of `size` distant users that k-means++ picks, for each user."""
    from sklearn.cluster import kmeans_plusplus

    chosen = np.asarray(kmeans_plusplus(profiles, size, random_state=int(generator.integers(2**31)))[1])
    away = [((profiles - profiles[user]) ** 2).sum(axis=1) for user in chosen]
    return np.stack(away).argmin(axis=0)


def _maximised(family: OutcomeFamily, shares: Array, steps: int) -> tuple[Array, float]:
    """Shares and log likelihood at the end of expectation–maximisation from `shares`."""
    likelihood, before = -np.inf, -np.inf
    for _ in range(steps):
        shares, likelihood = _expected(family, shares, shares.mean(axis=0))
        if likelihood - before < ENOUGH * abs(likelihood):
            break
        before = likelihood
    return shares, likelihood


def _expected(family: OutcomeFamily, shares: Array, weights: Array) -> tuple[Array, float]:
    """Each user's shares in the types fitted to `shares`, and the log likelihood of all outcomes."""
    with np.errstate(divide="ignore"):
        joint = family.stats @ family.fit(shares).T + np.log(weights)
    shares, each = normalised(joint)
    return shares, float(each.sum())


def _named(shares: Array) -> UserTypes:
    """The types that are the most probable type of a user, the most common type first."""
    used = np.unique(shares.argmax(axis=1))
    probs = shares[:, used] / shares[:, used].sum(axis=1, keepdims=True)
    order = np.argsort(-probs.mean(axis=0), kind="stable")
    return UserTypes(probs[:, order], probs.mean(axis=0)[order])


def _checked(rows: OutcomeRows) -> OutcomeRows:
    if not len(rows.values) or not np.isfinite(rows.values).all():
        raise InputError("values must be finite, at least one")
    met = rows.sums() > 0
    if not met.any(axis=1).all() or not met.any(axis=0).all():
        raise InputError("every user and every policy needs a row; leave out users and policies without rows")
    return rows
