"""Fit of `JointNormalOutcomes` to users' outcomes by expectation–maximisation; users need not know every policy.

    E   for each user the law of u given its outcomes, and its probabilities of types
    M   μ: generalised least squares; Σ, v: expected second moments; weights: mean probabilities

Σ has an inverse Wishart prior around its own diagonal: each step mixes it with its diagonal as if that came from
`shrinkage` users. Their number is the one under which held-out users are likeliest, so that few users give a
covariance that is nearly diagonal. Little and Rubin (2019, §11.2); mixtures as in McLachlan and Peel (2000).

Where nobody has two outcomes with a policy, they tell Σ's diagonal and v by their sum alone. What of it Σ's other
entries do not need is then divided in halves.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.outcomes.joint_normal_law import LOG_2_PI, Tried
from lifelore.interaction.outcomes.joint_normal_outcomes import JointNormalOutcomes
from lifelore.interaction.outcomes.log_probability import normalised
from lifelore.interaction.outcomes.outcome_moments import least_variance
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows

Array = NDArray[Any]

SEARCH, STEPS, ENOUGH = 12, 40, 1e-4
"""Largest number of steps for each shrinkage tried, and of the fit; the gain in log likelihood an outcome below
which they end."""
SHRINKAGES = (30.0, 3.0, 1.0, 0.3, 0.1, 0.03)
"""Users of the prior around the diagonal that are tried, as multiples of the number of policies."""
PARTS, MANY = 4, 200
"""Parts of the users; each is held out once to choose the shrinkage, of `MANY` users only the first part."""
PAIRS = 20.0
"""Pairs of a user's outcomes that the start of a covariance counts beside those of the users."""
PSEUDO = 1.0
"""Outcomes of each type and policy, and of each policy's noise, that the numbers of all count as."""


class JointNormalFit(NamedTuple):
    """A fitted model.

    model : JointNormalOutcomes
    weights : (n_types,), share of users
    probs : (n_users, n_types), P(type | the user's outcomes)
    shrinkage : users that the prior around Σ's diagonal counts as
    log_likelihood : of all outcomes
    """

    model: JointNormalOutcomes
    weights: Array
    probs: Array
    shrinkage: float
    log_likelihood: float


def joint_normal_fit(
    rows: OutcomeRows,
    probs: Array | None = None,
    shrinkage: float | None = None,
) -> JointNormalFit:
    """Fit to outcomes of users.

    Parameters
    ----------
    rows : OutcomeRows
        With numbers of users in place of types; every user and every policy has a row.
    probs : (n_users, n_types) float, optional
        Types to start from, as `user_types` finds them; a single type by default.
    shrinkage : float, optional
        Users, > 0; by default that under which held-out users (every fourth) are likeliest.

    Examples
    --------
    >>> values = np.array([9.0, 5.0, 8.0, 4.0, 3.0, 9.0, 2.0, 8.0, 7.0, 6.0, 6.0, 7.0])
    >>> rows = OutcomeRows(np.arange(12) // 2, np.arange(12) % 2, values, (6, 2))
    >>> found = joint_normal_fit(rows)
    >>> round(found.log_likelihood, 1)
    -21.4
    """
    users = UserMeans.of(rows)
    probs = np.ones((len(users.number), 1)) if probs is None else probs
    start = _likeliest_shrinkage(users, probs) if shrinkage is None else first_fit(users, probs, shrinkage)
    fit = _maximised(users, start, STEPS)
    return fit if (users.number > 1).any() else fit._replace(model=halved(fit.model))


class UserMeans(NamedTuple):
    """Number, mean and sum of squares around it of each user's outcomes with each policy, (n_users, n_policies).

    least : smallest variance of noise
    """

    number: Array
    mean: Array
    squares: Array
    least: float

    @classmethod
    def of(cls, rows: OutcomeRows) -> "UserMeans":
        """Of outcomes with numbers of users in place of types."""
        number = rows.sums()
        mean = rows.sums(rows.values) / np.maximum(number, 1)
        squares = rows.sums((rows.values - mean[rows.types, rows.policies]) ** 2)
        return cls(number, mean, squares, least_variance(rows.values))

    def take(self, users: Array) -> "UserMeans":
        """Of some users."""
        return UserMeans(self.number[users], self.mean[users], self.squares[users], self.least)

    @property
    def of_all(self) -> Array:
        """Mean outcome of each policy, that of all outcomes where it has none, (n_policies,)."""
        total = (self.number * self.mean).sum(axis=0)
        return (total + 1e-9 * total.sum() / self.number.sum()) / (self.number.sum(axis=0) + 1e-9)


def first_fit(users: UserMeans, probs: Array, shrinkage: float) -> JointNormalFit:
    """The fit to start from: the covariance is the mean product of two outcomes of a user, one variance for all.

    Steps change a covariance slowly where noise is large, so that the start counts.
    """
    number, weight = users.number, probs.T @ users.number
    mean = (probs.T @ (number * users.mean) + PSEUDO * users.of_all) / (weight + PSEUDO)
    apart = users.mean - probs @ mean
    total, square = number * apart, users.squares + number * apart**2
    pairs, products = number.T @ number, total.T @ total
    own_pairs, own_products = np.trace(pairs) - number.sum(), np.trace(products) - square.sum()
    whole = square.sum() / number.sum() + users.least
    variance = np.clip((own_products + PAIRS * whole / 2) / (own_pairs + PAIRS), 0.02 * whole, 0.9 * whole)
    covariance = products / (pairs + PAIRS)
    np.fill_diagonal(covariance, variance)
    values, vectors = np.linalg.eigh(covariance)
    covariance = (vectors * values.clip(variance / 10)) @ vectors.T
    model = JointNormalOutcomes(mean, covariance, np.full(len(covariance), np.sqrt(whole - variance)))
    return JointNormalFit(model, probs.mean(axis=0), probs, shrinkage, -np.inf)


def halved(model: JointNormalOutcomes) -> JointNormalOutcomes:
    """The model whose noise is half of a policy's own variance, of outcomes that no other policy shares.

    Single outcomes of policies have the same likelihood.
    """
    diagonal = np.diag(model.covariance)
    scale = np.sqrt(np.outer(diagonal, diagonal))
    unshared = max(np.linalg.eigvalsh(model.covariance / scale)[0], 0.0) * diagonal
    half = (unshared + model.noise**2) / 2
    return JointNormalOutcomes(model.mean, model.covariance + np.diag(half - unshared), np.sqrt(half))


def _likeliest_shrinkage(users: UserMeans, probs: Array) -> JointNormalFit:
    """A fit to some users with the shrinkage that makes the others likeliest; each starts from the one before."""
    n_users, n_policies = users.number.shape
    found = first_fit(users, probs, SHRINKAGES[0] * n_policies)
    if n_users < PARTS:
        return found
    held_out = [np.arange(n_users) % PARTS == part for part in range(PARTS if n_users < MANY else 1)]
    fits = [first_fit(users.take(~out), probs[~out], 0.0) for out in held_out]
    best = -np.inf
    for multiple in SHRINKAGES:
        likelihood = 0.0
        for place, out in enumerate(held_out):
            start = fits[place]._replace(shrinkage=multiple * n_policies)
            fits[place] = _maximised(users.take(~out), start, SEARCH)
            likelihood += expected(users.take(out), fits[place])[1].log_likelihood
        if likelihood > best:
            best, found = likelihood, fits[0]
    return found


def _maximised(users: UserMeans, fit: JointNormalFit, steps: int) -> JointNormalFit:
    enough, before = ENOUGH * users.number.sum(), -np.inf
    for _ in range(steps):
        fit = step(users, fit)
        if fit.log_likelihood - before < enough:
            break
        before = fit.log_likelihood
    return expected(users, fit)[1]


def expected(users: UserMeans, fit: JointNormalFit) -> tuple[Tried, JointNormalFit]:
    """What users have tried, and the fit with their probabilities of types and log likelihood."""
    model, square = fit.model, fit.model.noise**2
    tried = Tried.of(users.number / square, model.covariance)
    residual = tried.residual(tried.root * np.take_along_axis(users.mean, tried.places, axis=1), model.mean)
    noise = users.number @ (np.log(square) + LOG_2_PI) + (users.squares / square).sum(axis=1)
    height = -np.log(np.diagonal(tried.inverse, axis1=1, axis2=2)).sum(axis=1)
    likelihood = -0.5 * (noise[:, None] + (residual**2).sum(axis=2)) - height[:, None]
    with np.errstate(divide="ignore"):
        joint = likelihood + np.log(fit.weights)
    probs, each = normalised(joint)
    return tried, fit._replace(probs=probs, log_likelihood=float(each.sum()))


def step(users: UserMeans, fit: JointNormalFit) -> JointNormalFit:
    """A step of expectation–maximisation; the log likelihood is that of the fit before it."""
    tried, fit = expected(users, fit)
    square, probs, (n_users, n_policies) = fit.model.noise**2, fit.probs, users.number.shape
    # Precision of the means of what a user has tried, W = R K⁻ᵀ K⁻¹ R, (n_users, m, m).
    half = tried.inverse * tried.root[:, None]
    precision = half.transpose(0, 2, 1) @ half
    means = np.take_along_axis(users.mean, tried.places, axis=1)
    mean = np.empty_like(fit.model.mean)
    prior = np.diag(PSEUDO / (np.diag(fit.model.covariance) + square))
    for type_, share in enumerate(probs.T):
        told = share[:, None] * (precision @ means[:, :, None])[..., 0]
        total = np.bincount(tried.places.ravel(), told.ravel(), minlength=n_policies) + prior @ users.of_all
        mean[type_] = np.linalg.solve(_summed(share[:, None, None] * precision, tried, n_policies) + prior, total)
    # W (x̄ − μ) of every policy, by type.
    pull = np.zeros((probs.shape[1], *users.number.shape))
    gap = means[None] - mean[:, tried.places]
    np.put_along_axis(pull, tried.places[None], (precision @ gap[..., None])[..., 0], axis=2)
    shared = np.sqrt(probs.T)[:, :, None] * pull
    apart = (shared.transpose(0, 2, 1) @ shared).sum(axis=0) - _summed(precision, tried, n_policies)
    covariance = fit.model.covariance
    covariance = n_users * covariance + covariance @ apart @ covariance
    covariance += fit.shrinkage * np.diag(np.diag(covariance)) / n_users
    noise = _noise(users, tried, precision, (shared**2).sum(axis=0), square)
    covariance = (covariance + covariance.T) / 2 / (n_users + fit.shrinkage)
    return fit._replace(model=JointNormalOutcomes(mean, covariance, noise), weights=probs.mean(axis=0))


def _summed(of_users: Array, tried: Tried, n_policies: int) -> Array:
    """Sum over users of matrices of what they have tried (n_users, m, m), (n_policies, n_policies)."""
    place = tried.places[:, :, None] * n_policies + tried.places[:, None, :]
    found = np.bincount(place.ravel(), of_users.ravel(), minlength=n_policies**2)
    return found.reshape(n_policies, n_policies)


def _noise(users: UserMeans, tried: Tried, precision: Array, pull_square: Array, square: Array) -> Array:
    """Deviation of each policy's noise: that of all policies counts as `PSEUDO` outcomes."""
    own = np.zeros_like(users.number)
    np.put_along_axis(own, tried.places, np.diagonal(precision, axis1=1, axis2=2), axis=1)
    told = np.where(users.number > 0, square + square**2 * (pull_square - own) / np.maximum(users.number, 1), 0.0)
    total, number = (users.squares + told).sum(axis=0), users.number.sum(axis=0)
    pooled = total.sum() / number.sum()
    return np.sqrt(np.maximum((total + PSEUDO * pooled) / (number + PSEUDO), users.least))
