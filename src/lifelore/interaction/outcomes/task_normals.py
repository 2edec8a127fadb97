"""Normal outcomes of one task, whose means and variances are known from a finite number of runs.

    given a type, mean and variance of a pair have a normal-inverse-χ² law: location m₀, variance v₀ with ν₀
    degrees of freedom, and the weight of κ₀ = 1 / (1/n + ρ) outcomes, ρ the spread of the tasks of a type

After k outcomes of the task under a policy, with mean x̄ and sum of squares S, the law is of the same kind:

    κ = κ₀ + k     m = (κ₀ m₀ + k x̄) / κ     ν = ν₀ + k     ν v = ν₀ v₀ + S + (κ₀ k / κ)(x̄ − m₀)²

and the next outcome has a t distribution with ν degrees of freedom, location m and scale² = v (1 + 1/κ). So the
parameters are never drawn: (k, x̄, S) of each policy that was tried is all that a task needs. Pairs that are known
exactly (n and ν₀ infinite, no spread) keep their normal distribution. Thesis: §4.3.4; models as in §4.4.1.
"""

from collections.abc import Iterable
from functools import lru_cache
from math import lgamma, log, pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.array_log import log1ps, logs, ndtrs
from lifelore.core.compiled.compiler_start import kernel_pays
from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import informative_cuts
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.outcome_model import LARGEST, is_outcome, over_pairs, refuse_outcome
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.outcomes.special_functions import gammaln, ndtr, stdtr
from lifelore.interaction.outcomes.spread import GRID, Spread, held_out, likeliest
from lifelore.interaction.outcomes.task_outcomes import (
    NOTHING,
    TaskEvidence,
    TaskOutcomes,
    normal_excess,
    task_kernels,
)

Array = NDArray[np.float64]

LEAST_FREEDOM = 0.5
"""Least ν − 2 in the variance of a t distribution: below it would be infinite, and nothing compares."""
LARGEST_FREEDOM = 1e7
"""Degrees of freedom above which a t distribution is computed as this one's."""
LARGEST_SQUARE = 1e300
"""Squared scales and squared distances count as at most this, so that no logarithm overflows."""
_UNTRIED = np.zeros(3)
"""What a policy has shown that was never tried."""
_ROOT_2_PI = np.sqrt(2 * np.pi)


class TaskNormals(TaskOutcomes):
    """P(U | type, policy) in one task, given the outcomes it has shown.

    Parameters
    ----------
    moments : OutcomeMoments
        What the runs of the library say; read once and not changed.
    spread : Spread

    Attributes
    ----------
    mean, mean_variance, noise : (n_types, n_policies) float64
        Expected mean outcome of a pair, variance of that mean (what is not known about it), and expected variance
        of outcomes around it.
    """

    def __init__(self, moments: OutcomeMoments, spread: Spread) -> None:
        super().__init__(spread)
        # Policy first: an update reads the row of a policy. Copies: the task does not see what is learnt later.
        self._location = np.array(moments.mean.T, order="C")
        self._variance = np.array(moments.variance.T, order="C")
        self._rarity = np.ascontiguousarray(1 / moments.count.T)
        self._doubt = np.ascontiguousarray(1 / moments.freedom.T)
        # Count, mean and sum of squares of each policy's outcomes, and the policies in the order of their trials.
        self._numbers = np.zeros((len(self._location), 3))
        self._tried: list[int] = []
        self._alike = (self._doubt == self._doubt[:, :1]).all(axis=1).tolist()
        # Rows of a policy that an update reads: location, variance, 1/n, 1/ν, and heights before any outcome.
        self._policy_rows: dict[int, tuple[Array, ...]] = {}
        self._log_first = np.log(spread.weights)
        # Policies whose law has changed since their columns were computed: of the means, and of all else.
        self._stale_means: set[int] = set()
        self._stale: set[int] = set()
        factor = variance_factor(moments.freedom)
        self._mean, self._noise = moments.mean.copy(), moments.variance * factor
        self._of_runs, self._of_spread = self._noise / moments.count, self._noise.copy()
        self._freedom = np.minimum(moments.freedom, LARGEST_FREEDOM)
        self._tried_variance = np.zeros(self._mean.shape)

    # ---- what the task has shown ---------------------------------------------------------------------------

    def predicted(self, policy: int, value: float) -> Array:
        """The log density of `value` given what the task has shown, (n_spreads, n_types)."""
        self._check(policy, value)
        return self._log_density(policy, value, self._numbers[policy] if self._numbers[policy, 0] else _UNTRIED)

    def predicted_anew(self, policy: int, value: float) -> Array:
        """`predicted` of a task that has shown nothing."""
        self._check(policy, value)
        return self._log_density(policy, value, _UNTRIED)

    def evidence(self, policy: int, signal: float, log_belief: Array, log_anew: Array | None) -> TaskEvidence:
        """The evidence of an outcome, before it is taken in; see `evidence_of`."""
        if not kernel_pays(8 * log_belief.size * len(self.log_weights)):
            return super().evidence(policy, signal, log_belief, log_anew)
        self._check(policy, signal)
        rows = self._rows_of(policy)
        shown, n = self._numbers[policy], len(log_belief)
        found = TaskEvidence(np.empty(n), np.empty(n), np.zeros(len(self.log_weights)))
        count = float(shown[0])
        task_kernels().task_evidence(
            float(signal),
            shown,
            *rows[:4],
            self.spread.values,
            self._heights(policy, count) if count else rows[4],
            rows[4],
            self.log_weights,
            self._log_first,
            log_belief,
            NOTHING if log_anew is None else log_anew,
            *found,
        )
        return found

    def learn(self, policy: int, value: float, log_weights: Array | None = None) -> None:
        """Take in an outcome of this task, and the spreads' log probabilities after it."""
        k, mean, squares = self._numbers[policy].tolist()
        before = value - mean
        self._numbers[policy] = k + 1, mean + before / (k + 1), squares + before**2 * (k / (k + 1))
        if policy not in self._tried:
            self._tried.append(policy)
        if log_weights is not None:
            self.log_weights = log_weights
        self._changed(self._tried if len(self.log_weights) > 1 else (policy,))

    @property
    def tried(self) -> list[int]:
        """The policies that have shown an outcome, in the order of their first."""
        return list(self._tried)

    @property
    def shown(self) -> dict[int, tuple[float, float, float]]:
        """Number, mean and sum of squares around the mean of the outcomes of each policy that was tried."""
        return {policy: tuple(self._numbers[policy].tolist()) for policy in self._tried}

    def fade(self, keep: float) -> None:
        """Let everything that the task has shown count `keep` of what it did; the type may have changed."""
        self._numbers[:, 0] *= keep
        self._numbers[:, 2] *= keep
        self.fade_weights(keep)
        self._changed(self._tried)

    def state(self) -> dict[str, NDArray[Any]]:
        """What the task has shown: ``policies`` (m,), ``shown`` (m, 3): k, mean, squares; ``log_weights``."""
        return {
            "policies": np.array(self._tried, np.int64),
            "shown": self._numbers[self._tried].reshape(-1, 3),
            "log_weights": self.log_weights.copy(),
        }

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Take over a `state`; the model then has the same bits."""
        shown = np.asarray(state["shown"], np.float64)
        policies = np.asarray(state["policies"], np.int64)
        good = shown.shape == (len(policies), 3) and (shown[:, [0, 2]] >= 0).all() and np.isfinite(shown).all()
        if not good or (policies.size and not 0 <= policies.min() <= policies.max() < self.n_policies):
            raise InputError("a task's state must have policies and (count, mean, squares) of each")
        self.restore_weights(state["log_weights"])
        self._tried = policies.tolist()
        self._numbers[:] = 0.0
        self._numbers[policies] = shown
        self._changed(self._tried)

    # ---- the model as rules use it -------------------------------------------------------------------------

    @property
    def mean(self) -> Array:  # type: ignore[override]
        """Expected mean outcome of each pair, (n_types, n_policies); read only."""
        if self._stale_means:
            self._renew_means()
        return self._mean

    @property
    def noise(self) -> Array:
        """Expected variance of a pair's outcomes around their mean, (n_types, n_policies); read only."""
        if self._stale:
            self._renew()
        return self._noise

    @property
    def mean_variance(self) -> Array:
        """Variance of each pair's mean outcome, (n_types, n_policies)."""
        if self._stale:
            self._renew()
        found = self._of_runs + self._of_spread * self._expected_spread()
        found[:, self._tried] = self._tried_variance[:, self._tried]
        return found

    @property
    def deviation(self) -> Array:
        """Standard deviation of the next outcome, (n_types, n_policies)."""
        return np.sqrt(self.mean_variance + self.noise)

    @property
    def freedom(self) -> Array:
        """Degrees of freedom of the next outcome, at most `LARGEST_FREEDOM`, (n_types, n_policies)."""
        return self._freedom + self._numbers[:, 0]

    @property
    def scale(self) -> Array:
        """Scale of the t distribution of the next outcome, (n_types, n_policies)."""
        return self.deviation / np.sqrt(variance_factor(self.freedom))

    def expected_mean_excess(self, threshold: ArrayLike) -> Array:
        """E[max(m − threshold, 0)] of each pair's mean outcome m, taken as normal, (..., n_types, n_policies)."""
        if np.ndim(threshold) == 0 and kernel_pays(8 * self._mean.size):
            if self._stale:
                self._renew()
            excess = np.empty_like(self._mean)
            task_kernels().mean_excess(
                self._mean,
                self._of_runs,
                self._of_spread,
                self._expected_spread(),
                np.array(self._tried, np.int64),
                self._tried_variance,
                float(threshold),  # pyright: ignore[reportArgumentType]
                excess,
            )
            return excess
        return normal_excess(self.mean - over_pairs(threshold), self.mean_variance)

    def density(self, value: ArrayLike) -> Array:
        """Density of `value` for every pair, (..., n_types, n_policies)."""
        freedom, scale = self.freedom, self.scale
        z = (over_pairs(value) - self.mean) / scale
        half = 0.5 * freedom
        height = gammaln(half + 0.5) - gammaln(half) - 0.5 * np.log(np.pi * freedom)
        return np.exp(height - (half + 0.5) * np.log1p(z * z / freedom)) / scale

    def exceedance(self, threshold: ArrayLike) -> Array:
        """P(U > threshold) for every pair, (..., n_types, n_policies)."""
        return stdtr(self.freedom, (self.mean - over_pairs(threshold)) / self.scale)

    def expected_excess(self, threshold: ArrayLike) -> Array:
        """E[max(U − threshold, 0)] for every pair, outcomes taken as normal, (..., n_types, n_policies)."""
        deviation = self.deviation
        z = (self.mean - over_pairs(threshold)) / deviation
        return np.maximum(deviation * (z * ndtr(z) + np.exp(-0.5 * z * z) / _ROOT_2_PI), 0.0)

    def cumulative(self, policy: int, values: Array, types: Any = slice(None)) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), for all or some types, (n_types, n)."""
        noise = self.noise[:, policy]
        freedom = self._freedom[types, policy] + self._numbers[policy, 0]
        if policy in self._tried:
            variance = self._tried_variance[:, policy]
        else:
            variance = self._of_runs[:, policy] + self._of_spread[:, policy] * self._expected_spread()
        scale = np.sqrt((variance[types] + noise[types]) / variance_factor(freedom))
        z = (values - self.mean[types, policy][:, None]) / scale[:, None]
        return stdtr(freedom[:, None], z)

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): four deviations around the means."""
        deviation = self.deviation
        return float((self.mean - 4 * deviation).min()), float((self.mean + 4 * deviation).max())

    def cuts(self, n_bins: int) -> list[Array]:
        """Cuts of each policy's outcomes into bins that tell the types apart, as they are now."""
        return [informative_cuts(self, policy, n_bins) for policy in range(self.n_policies)]

    def table_rows(self, policy: int, cuts: Array, n_bins: int) -> Array:
        """P(bin | type) of the next outcome of a policy, taken as normal, (n_types, n_bins)."""
        return self.many_rows([policy], [cuts], n_bins)[0]

    def many_rows(self, policies: list[int], cuts: list[Array], n_bins: int) -> Array:
        """`table_rows` of policies, (n, n_types, n_bins)."""
        mean, deviation, chosen = self.mean, self.deviation, np.array(policies)
        # A policy with fewer cuts leaves its last bins empty.
        filled = np.full((len(policies), n_bins - 1), np.inf)
        for row, own in zip(filled, cuts, strict=True):
            row[: len(own)] = own
        cut = np.minimum(filled, LARGEST**2)
        if kernel_pays(8 * self.n_types * cut.size):
            below = np.empty((len(policies), self.n_types, n_bins - 1))
            task_kernels().normal_below(chosen, cut, mean, deviation, below)
        else:
            below = ndtrs((cut[:, None] - mean.T[chosen, :, None]) / deviation.T[chosen, :, None])
        probs = np.empty((len(policies), self.n_types, n_bins))
        probs[..., :1] = below[..., :1]
        np.subtract(below[..., 1:], below[..., :-1], out=probs[..., 1:-1])
        np.subtract(1.0, below[..., -1], out=probs[..., -1])
        return np.maximum(probs, 0.0, out=probs)

    def table(self, n_bins: int = 8) -> SignalTable:
        """The next outcome in bins that tell the types apart."""
        return SignalTable(self.many_rows(list(range(self.n_policies)), self.cuts(n_bins), n_bins), copy=False)

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random next outcomes of a pair: a number, or an array of shape `size`."""
        drawn = generator.standard_t(self.freedom[type_, policy], size)
        return self.mean[type_, policy] + self.scale[type_, policy] * drawn

    # ---- the law of a policy's pairs -----------------------------------------------------------------------

    def _check(self, policy: int, value: float) -> None:
        if not is_outcome(policy, value, len(self._location)):
            refuse_outcome(policy, value, self.n_policies)

    def _law(self, policies: Any, shown: Any) -> tuple[Array, Array, Array, Array]:
        """Location, 1/κ and variance by spread and type, (..., n_spreads, n_types), and degrees of freedom.

        `shown` is (k, mean, squares) of a policy, or arrays (m, 1, 1) of `policies` (m,).
        """
        k, mean, squares = shown
        place = (policies, None)
        location, variance, doubt = self._location[place], self._variance[place], self._doubt[place]
        rarity = self._rarity[place] + self.spread.values[:, None]
        grown = 1 + k * rarity
        apart = mean - location
        left = rarity / grown
        with np.errstate(divide="ignore", over="ignore"):
            freedom = 1 / doubt + k
            found = (variance + doubt * (squares + k / grown * (apart * apart))) / (1 + doubt * k)
        return location + k * left * apart, left, np.minimum(found, LARGEST**2), freedom

    def _rows_of(self, policy: int) -> tuple[Array, ...]:
        """Location, variance, 1/n, 1/ν and the heights before any outcome, (n_types,) each."""
        rows = self._policy_rows.get(policy)
        if rows is None:
            laws = (self._location, self._variance, self._rarity, self._doubt)
            rows = self._policy_rows[policy] = (*(law[policy] for law in laws), self._heights(policy, 0.0))
        return rows

    def _log_density(self, policy: int, value: float, shown: Array) -> Array:
        """Log densities of `value`, (n_spreads, n_types); compiled where that pays, with the same bits."""
        if kernel_pays(8 * self.n_types * len(self.log_weights)):
            *rows, new_heights = self._rows_of(policy)
            heights = self._heights(policy, float(shown[0])) if shown[0] else new_heights
            found = np.empty((len(self.log_weights), self.n_types))
            task_kernels().densities(float(value), shown, *rows, self.spread.values, heights, found)
            return found
        location, rarity, variance, freedom = self._law(policy, shown)
        square = np.minimum(variance * (1 + rarity), LARGEST_SQUARE)
        gap = value - location
        z2 = gap * gap / square
        normal = freedom == np.inf
        finite = np.where(normal, 1.0, freedom)
        tail = 0.5 * (finite + 1) * log1ps(np.minimum(z2 / finite, LARGEST_SQUARE))
        return self._heights(policy, float(shown[0])) - 0.5 * logs(square) - np.where(normal, 0.5 * z2, tail)

    def _heights(self, policy: int, count: float) -> Array:
        """Log densities at the location, scale 1, of a policy with `count` outcomes, (n_types,)."""
        doubt = self._doubt[policy]
        if self._alike[policy]:
            first = float(doubt[0])
            return _equal_heights(1 / first + count if first else np.inf, len(doubt))
        with np.errstate(divide="ignore"):
            freedom = 1 / doubt + count
        return np.array([_height(value) for value in freedom.tolist()])

    def _expected_spread(self) -> float:
        """Expectation of the spread, given what the task has shown."""
        return float(np.exp(self.log_weights) @ self.spread.values)

    def _changed(self, policies: Iterable[int]) -> None:
        self._stale_means.update(policies)
        self._stale.update(policies)

    def _renew_means(self) -> None:
        """Compute the means again of the policies whose law has changed; most rules need no more."""
        if not kernel_pays(8 * len(self._stale_means) * self._mean.shape[0] * len(self.log_weights)):
            self._renew()
            return
        policies = np.array(sorted(self._stale_means))
        self._stale_means.clear()
        weights = np.exp(self.log_weights)
        task_kernels().renew_means(
            policies,
            self._numbers[policies],
            self._location,
            self._rarity,
            self.spread.values,
            weights,
            self._mean,
        )

    def _renew(self) -> None:
        """Compute the columns of the policies again whose law has changed."""
        policies, weights = np.array(sorted(self._stale)), np.exp(self.log_weights)
        self._stale.clear()
        self._stale_means.clear()
        shown = self._numbers[policies]
        if kernel_pays(8 * len(policies) * self.n_types * len(weights)):
            task_kernels().renew(
                policies,
                shown,
                self._location,
                self._variance,
                self._rarity,
                self._doubt,
                self.spread.values,
                weights,
                self._mean,
                self._noise,
                self._tried_variance,
            )
            return
        location, rarity, variance, freedom = self._law(policies, shown.T[:, :, None, None])
        weights, factor = weights[:, None], variance_factor(freedom[:, 0])
        mean = (weights * location).sum(axis=1)
        self._mean[:, policies] = mean.T
        self._noise[:, policies] = (factor * (weights * variance).sum(axis=1)).T
        gap = location - mean[:, None]
        within = factor * (weights * (rarity * variance)).sum(axis=1)
        self._tried_variance[:, policies] = (within + (weights * (gap * gap)).sum(axis=1)).T


def variance_factor(freedom: Array) -> Array:
    """Variance of a t distribution of scale 1, ν / (ν − 2) with ν − 2 at least `LEAST_FREEDOM`."""
    return 1 + 2 / np.maximum(freedom - 2, LEAST_FREEDOM)


def spread_of(moments: OutcomeMoments) -> Spread:
    """The spreads that the moments' own types leave possible; none where there is a single type."""
    n_types, n_policies = moments.mean.shape
    if n_types < 2 or np.isinf(moments.count).any():
        return Spread.known(0.0)
    some = held_out(n_types, n_types * n_policies)
    rare = moments.variance / moments.count
    found = np.empty((len(GRID), len(some), n_types))
    for place, i in enumerate(some):
        apart = (moments.mean[i] - moments.mean) ** 2
        noise, unit = rare[i] + rare, moments.variance
        for number, value in enumerate(GRID):
            variance = noise + value * unit
            found[number, place] = -0.5 * (apart / variance + np.log(variance)).sum(axis=1)
        found[:, place, i] = -np.inf
    return Spread.up_to(likeliest(found))


@lru_cache(maxsize=1024)
def _equal_heights(freedom: float, n: int) -> Array:
    """`_height` of n types that are equally uncertain, (n,); read only."""
    return np.full(n, _height(freedom))


@lru_cache(maxsize=4096)
def _height(freedom: float) -> float:
    """Log of the density of Student's t at its location, scale 1."""
    if freedom > 1e6:
        # Differences of log Γ at large arguments lose their digits; the next term of this series is below 1e-18.
        return -0.5 * log(2 * pi) - (0.25 / freedom if freedom < np.inf else 0.0)
    return lgamma(0.5 * (freedom + 1)) - lgamma(0.5 * freedom) - 0.5 * log(pi * freedom)
