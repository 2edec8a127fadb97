"""Models learnt from few runs, in one task, by numerical integration: the slow twin of uncertain models.

Normal outcomes. Runs give a pair of type and policy the mean m₀ of n outcomes and the variance v₀ with ν degrees
of freedom. In a task the pair's variance v and mean m are unknown:

    ν v₀ / v has a χ² law with ν degrees of freedom        m given v is normal around m₀, variance v (1/n + ρ)

with the spread ρ of the tasks of a type. The density of outcomes is the integral of Π N(x | m, v) over both laws,
computed on a grid; no conjugate formula is used. Categories. The probabilities of a pair have a Dirichlet law of
weight A = 1 / (1/N + ρ) around those of the library, of N counts. The next category is that of a Pólya urn.

Weights of outcomes: an outcome of weight w counts as w outcomes (its likelihood to the power w); a task whose type
may have changed lets earlier outcomes count less. Nothing is imported from the code under test.
"""

from collections.abc import Callable, Sequence
from math import exp, fsum, inf, log, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from .naive_reuse import Logs, bayes, hazard, log_of, log_sum, normalised

Earlier = Sequence[tuple[Any, float]]
"""Outcomes that the task has shown under a policy, with their weights."""

NATS = 45.0
"""The grid ends where the integrand is e^-45 of its largest value or less."""


class NormalPair(NamedTuple):
    """What the runs of a pair say: m₀, v₀, n and ν; n and ν may be infinite."""

    mean: float
    variance: float
    runs: float
    freedom: float


# ---- normal outcomes --------------------------------------------------------------------------------------------


def parameters(
    pair: NormalPair, spread: float, values: Sequence[float]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A grid over (m, v) that covers the law of a pair and its law after `values`: m, v and log prior mass.

    The points are evenly spaced on both axes. The error of their sum for a normal bell is e^-(2π² / step²), with
    the step in deviations of the bell. Both steps are at most 1 / 1.5 of the narrowest bell: some e^-44.
    """
    doubt, k = 1 / pair.runs + spread, len(values)
    variances, masses = _variances(pair, values)
    means, grid_variances, logs = [], [], []
    for variance, mass in zip(variances, masses, strict=True):
        if doubt == 0:
            own, log_density = np.array([pair.mean]), np.zeros(1)
        else:
            prior, narrow = sqrt(variance * doubt), sqrt(variance / (1 / doubt + k))
            low = min(pair.mean - 10 * prior, min(values, default=inf) - 10 * narrow)
            high = max(pair.mean + 10 * prior, max(values, default=-inf) + 10 * narrow)
            # Beyond ten deviations of the prior and of the outcomes nothing is left; between them all is covered.
            own = np.linspace(low, high, int((high - low) / narrow * 1.5) + 2)
            step = own[1] - own[0]
            log_density = -0.5 * ((own - pair.mean) / prior) ** 2 - log(prior) - 0.5 * log(2 * pi) + log(step)
        means.append(own)
        grid_variances.append(np.full(len(own), variance))
        logs.append(log_density + mass)
    return np.concatenate(means), np.concatenate(grid_variances), np.concatenate(logs)


def _variances(pair: NormalPair, values: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Variances, evenly spaced in their logarithm, and the log prior mass of each."""
    nu, v0, k = pair.freedom, pair.variance, len(values)
    if nu == inf:
        return np.array([v0]), np.zeros(1)
    # With u = log v/v₀ the log density of u is −ν/2 (u + e^-u − 1) and falls to −q ν/2 below u = q + √2q. The
    # variance of outcomes is an integral of v times it, which falls as if ν were 2 less.
    gap = max([abs(value - pair.mean) for value in values], default=0.0)
    low = log(nu * v0 / (2 * (NATS + nu + k)))
    q = NATS / (0.5 * max(nu - 2, nu / 4))
    high = log(max(v0, gap**2)) + q + sqrt(2 * q)
    step = min(0.2, sqrt(2 / (nu + k)) / 1.5)
    log_v = np.arange(low, high + step, step)
    logs = -nu / 2 * log_v - nu * v0 / 2 * np.exp(-log_v)
    return np.exp(log_v), logs - log_total(logs)


def log_total(logs: np.ndarray) -> float:
    """log Σ exp over a grid."""
    top = logs.max()
    return float(top + np.log(np.exp(logs - top).sum()))


def log_likelihoods(means: np.ndarray, variances: np.ndarray, earlier: Earlier) -> np.ndarray:
    """Σ w log N(x | m, v) at each point of a grid."""
    total = np.zeros(len(means))
    for value, weight in earlier:
        total += weight * (-0.5 * (value - means) ** 2 / variances - 0.5 * np.log(2 * pi * variances))
    return total


def normal_predictive(pair: NormalPair, spread: float, earlier: Earlier, value: float) -> float:
    """Log density of the next outcome, given earlier outcomes of the same pair."""
    means, variances, logs = parameters(pair, spread, [value, *(x for x, _ in earlier)])
    before = logs + log_likelihoods(means, variances, earlier)
    after = before + log_likelihoods(means, variances, [(value, 1.0)])
    return log_total(after) - log_total(before)


class Moments(NamedTuple):
    """Expectation of a pair's mean outcome, variance of that mean, expected variance of outcomes around it."""

    mean: float
    mean_variance: float
    noise: float


def normal_moments(pair: NormalPair, spread: float, earlier: Earlier) -> Moments:
    """What a pair pays, given earlier outcomes; for more than two degrees of freedom."""
    means, variances, logs = parameters(pair, spread, [value for value, _ in earlier])
    logs = logs + log_likelihoods(means, variances, earlier)
    share = np.exp(logs - log_total(logs))
    mean = float(share @ means)
    return Moments(mean, float(share @ (means - mean) ** 2), float(share @ variances))


def over_spreads(found: Sequence[Moments], weights: Sequence[float]) -> Moments:
    """The moments of a mixture over spreads of probabilities `weights`."""
    mean = fsum(w * one.mean for w, one in zip(weights, found, strict=True))
    within = fsum(w * (one.mean_variance + (one.mean - mean) ** 2) for w, one in zip(weights, found, strict=True))
    return Moments(mean, within, fsum(w * one.noise for w, one in zip(weights, found, strict=True)))


# ---- categories -------------------------------------------------------------------------------------------------


def category_predictive(counts: Sequence[float], spread: float, earlier: Earlier, category: int) -> float:
    """Log probability of the next category, by an urn that the library filled and each category adds a ball to.

    Parameters
    ----------
    counts : (n_categories,) float
        Of the library, pseudo-counts included.
    """
    total = sum(counts)
    size = 1 / (1 / total + spread)
    urn = [size * count / total for count in counts]
    for shown, weight in earlier:
        urn[shown] += weight
    return log_of(urn[category]) - log(fsum(urn))


# ---- the belief over types, spreads and parameters --------------------------------------------------------------

Predictive = Callable[[int, int, float, Earlier, Any], float]
"""(type, policy, spread, earlier outcomes of the policy, outcome) to the log density of the outcome."""


def normal_law(pairs: Sequence[Sequence[NormalPair]]) -> Predictive:
    """The law of normal outcomes; `pairs` [type][policy]."""
    return lambda type_, policy, spread, earlier, value: normal_predictive(
        pairs[type_][policy], spread, earlier, value
    )


def category_law(counts: Sequence[Sequence[Sequence[float]]]) -> Predictive:
    """The law of categories; `counts` [type][policy][category]."""
    return lambda type_, policy, spread, earlier, category: category_predictive(
        counts[type_][policy], spread, earlier, category
    )


class NaiveUncertainReuse:
    """The belief about one user over types, spreads and the models' parameters.

    Types and spreads are taken as independent: a type's likelihood is averaged over the spreads, and a spread's
    over the types. With a hazard, w(τ) is the probability that a task which is now of type τ has just changed to
    it. A changed task has shown nothing, and afterwards all that was shown counts less by the probability that
    the type has just changed:

        F(σ | τ, π) = (1 − w_τ) F(σ | τ, π, all signals so far) + w_τ F(σ | τ, π)

    Parameters
    ----------
    prior : (n_types,) float
    spreads, weights : (n_spreads,) float
        Possible spreads and their probabilities before the task.
    predictive : Predictive
    rate : float
        Probability of a type drawn anew from `prior` between two signals.
    """

    def __init__(
        self,
        prior: Sequence[float],
        spreads: Sequence[float],
        weights: Sequence[float],
        predictive: Predictive,
        rate: float = 0.0,
    ) -> None:
        self.prior, self.spreads, self.predictive, self.rate = list(prior), list(spreads), predictive, rate
        self.log_belief: Logs = [log_of(p) for p in prior]
        self.first = [log_of(w) for w in weights]
        self.log_weights: Logs = list(self.first)
        self.shown: dict[int, list[tuple[Any, float]]] = {}
        self.begun = True

    def update(self, policy: int, value: Any) -> float:
        """An episode of a single outcome; the log evidence."""
        evidence = self.observe(policy, value)
        self.end_episode()
        return evidence

    def end_episode(self) -> None:
        """Take the step of the hazard."""
        self.log_belief, self.begun = self._stepped(self.log_belief), True

    def observe(self, policy: int, value: Any) -> float:
        """Learn from an outcome within an episode; the log evidence.

        A value that no type explains teaches nothing. Only before the first outcome of an episode may the type
        have changed.
        """
        before, types, earlier = self.log_belief, range(len(self.prior)), self.shown.get(policy, [])
        known = [[self.predictive(t, policy, rho, earlier, value) for t in types] for rho in self.spreads]
        fresh = [[self.predictive(t, policy, rho, [], value) for t in types] for rho in self.spreads]
        likelihood, changed = [], []
        for t in types:
            share = self._changed_share(before[t], t)
            stays = log_of(1 - share) + log_sum(
                [w + row[t] for w, row in zip(self.log_weights, known, strict=True)]
            )
            anew = log_of(share) + log_sum([w + row[t] for w, row in zip(self.first, fresh, strict=True)])
            likelihood.append(log_sum([stays, anew]))
            changed.append(exp(anew - likelihood[-1]) if likelihood[-1] > -inf else 0.0)
        after, evidence = bayes(before, likelihood)
        self.log_belief, self.begun = after, False
        if evidence == -inf:
            return evidence
        self._fade(1 - min(fsum(exp(a) * share for a, share in zip(after, changed, strict=True)), 1.0))
        if len(self.spreads) > 1:
            gains = [log_sum([f + b for f, b in zip(row, before, strict=True)]) for row in known]
            self.log_weights = normalised([w + gain for w, gain in zip(self.log_weights, gains, strict=True)])
        self.shown.setdefault(policy, []).append((value, 1.0))
        return evidence

    @property
    def belief(self) -> list[float]:
        """β, (n_types,), sums to 1."""
        return [exp(b) for b in normalised(self.log_belief)]

    @property
    def weights(self) -> list[float]:
        """Probabilities of the spreads, (n_spreads,)."""
        return [exp(w) for w in self.log_weights]

    def _changed_share(self, log_belief: float, type_: int) -> float:
        """P(the type has just changed | it is now this type)."""
        anew = self.rate * self.prior[type_] if self.begun else 0.0
        return min(exp(log(anew) - log_belief), 1.0) if anew > 0 else 0.0

    def _stepped(self, log_belief: Logs) -> Logs:
        return hazard(self.rate, self.prior)(log_belief) if self.rate else log_belief

    def _fade(self, keep: float) -> None:
        """Let all that was shown count `keep` of what it did; else the spread is drawn anew."""
        pairs = zip(self.log_weights, self.first, strict=True)
        self.log_weights = [log_of(keep * exp(now) + (1 - keep) * exp(first)) for now, first in pairs]
        for shown in self.shown.values():
            shown[:] = [(value, keep * weight) for value, weight in shown]
