"""The law of numbers: normal outcomes whose mean and variance are known from a finite number of runs.

    given a type, mean and variance of a pair have a normal-inverse-χ² law: location m₀, variance v₀ with ν₀
    degrees of freedom, and the weight of κ₀ = 1 / (1/n + ρ) outcomes, ρ the spread of the users of a type

After k outcomes of a user under a policy, with mean x̄ and sum of squares S, the law is of the same kind:

    κ = κ₀ + k     m = (κ₀ m₀ + k x̄) / κ     ν = ν₀ + k     ν v = ν₀ v₀ + S + (κ₀ k / κ)(x̄ − m₀)²

and the next outcome has a t distribution with ν degrees of freedom, location m and scale² = v (1 + 1/κ). So the
parameters are never drawn: (k, x̄, S) of each user and policy is all that is needed. Pairs that are known exactly
(n and ν₀ infinite, no spread) keep their normal distribution. Thesis: §4.3.4; models as in §4.4.1.
"""

from functools import cached_property, lru_cache
from math import log, pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.finite_signals.signal_bins import normal_probs, normal_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.law import Law, Numbers, filled, of_users
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.outcomes.outcome_rows import finite_outcomes
from lifelore.interaction.outcomes.prediction import NormalPrediction, over_pairs
from lifelore.interaction.outcomes.special_functions import stdtr
from lifelore.interaction.outcomes.spread import GRID, Spread, held_out, likeliest

Array = NDArray[Any]

EXACT = 1e30
"""Degrees of freedom of a variance that is known exactly: t is then normal to the last digit."""
LARGEST_FREEDOM = 1e6
"""Degrees of freedom above which the distribution function of t is that of 1e6, which SciPy computes well."""
FARTHEST = 1e15
"""Deviations as which outcomes that are farther count in float32: their squares stay numbers."""
FEW = 256
"""Numbers up to which heights are looked up one by one: a single user shows the same numbers again."""
SHIFT = 10
"""Steps before the series of log Γ: what the series leaves out is then below 1e-15."""
_SERIES = (691 / 180224, -31 / 18432, 17 / 14336, -1 / 640, 1 / 192, -1 / 8)
LEAST_FREEDOM = 0.5
"""Least ν − 2 in the variance of a t distribution: below it would be infinite, and nothing compares."""


class Posterior(NamedTuple):
    """The law of pairs after what users have shown, (..., n_spreads or 1, n_types or 1) each, or a float.

    location : m
    doubt : 1/κ
    squares : ν v
    freedom : ν
    """

    location: Any
    doubt: Any
    squares: Any
    freedom: Any


class NormalLaw(Law):
    """P(number | type, policy) given what each user has shown, Student's t.

    Parameters
    ----------
    moments : OutcomeMoments
        What the runs of the library say; read once.
    spread : Spread
    dtype : {"f8", "f4"}
        Precision of the statistics and of the likelihoods. float32 counts in deviations from the middle of the
        types' means, at most `FARTHEST`.
    """

    amounts = slice(None, None, 2)

    def __init__(self, moments: OutcomeMoments, spread: Spread, dtype: str = "f8") -> None:
        self.spread, self.dtype = spread, np.dtype(dtype)
        self.n_types, self.n_policies = moments.mean.shape
        self.shape = (self.n_policies, 3)  # number, mean and sum of squares around the mean of outcomes
        mean, variance = moments.mean.T, moments.variance.T
        single = self.dtype == np.float32
        self.middle = mean.mean(axis=1) if single else np.zeros(len(mean))
        self.unit = np.sqrt(variance.mean(axis=1)) if single else np.ones(len(mean))
        # Policy first: a signal reads the rows of its policy, (n_policies, n_spreads or 1, n_types or 1). Types
        # that are alike share a column.
        mean, variance = (mean - self.middle[:, None]) / self.unit[:, None], variance / self.unit[:, None] ** 2
        rarity, freedom = _alike(1 / moments.count.T), _alike(np.minimum(moments.freedom.T, EXACT))
        doubt, freedom = rarity[:, None] + spread.values[:, None], freedom[:, None]
        square, power = variance[:, None] * (1 + doubt), 0.5 * (freedom + 1)
        height = log_t_height(freedom) - np.log(self.unit)[:, None, None]
        before = (mean[:, None], doubt, variance[:, None] * freedom, freedom)
        self._before = Posterior(*map(self._stored, before))
        # Of each policy, with single numbers as floats: a single pair then takes a third of the time.
        self._of_policy = [
            Posterior(*(row.item() if row.size == 1 else row for row in rows))
            for rows in zip(*self._before, strict=True)
        ]
        self._power, self._log_unit = self._stored(power), self._stored(np.log(self.unit))
        # Student's t of users who have shown nothing: log density = top − power log1p(gap² narrow).
        self._narrow = self._stored(1 / (square * freedom))
        self._top = self._stored(height - 0.5 * np.log(square))
        factor = variance_factor(moments.freedom)
        self.mean, self.noise = moments.mean.copy(), moments.variance * factor
        self.of_runs, self.of_spread = self.noise / moments.count, self.noise
        self.natural_mean_of_types = self._stored(self.mean)
        self.natural_mean = np.ascontiguousarray(self.natural_mean_of_types.T)
        self._bins: dict[int, tuple[Array, SignalTable]] = {}

    # ---- the law of signals --------------------------------------------------------------------------------

    def checked(self, signals: Any) -> Array:
        """Finite numbers (k,)."""
        return finite_outcomes(signals)

    def log_likelihoods(
        self, policies: Numbers, signals: Any, shown: Array | None = None, users: Numbers = None
    ) -> Array:
        """Log densities of outcomes (...) given what `users` (...) have shown, (..., n_spreads, n_types)."""
        value = over_pairs(self._scaled(policies, signals))
        if shown is None:
            gap = value - of_users(self._before.location, policies)
            return self._top[policies] - self._power[policies] * np.log1p(gap * gap * self._narrow[policies])
        location, doubt, squares, freedom = self.posterior(policies, shown, users)
        height = self._stored(log_t_height(freedom)) - over_pairs(self._log_unit[policies])
        # In place: temporary arrays of many users would leave the processor's cache.
        gap, scale = value - location, squares
        gap *= gap
        scale *= 1 + doubt
        gap /= scale
        gap = np.log1p(gap)
        gap *= 0.5 * (freedom + 1)
        scale /= freedom
        found = np.log(scale)
        found *= -0.5
        found += height
        found -= gap
        return np.atleast_2d(found)

    def posterior(self, policies: Numbers, shown: Array, users: Numbers) -> Posterior:
        """The law of the pairs of `policies` (...) given what `users` (...) have shown."""
        found = self._shown_of(shown, users, policies)
        many = isinstance(policies, np.ndarray)
        before = (rows.take(policies, axis=0) for rows in self._before) if many else self._of_policy[policies]
        return self._after(found if found.ndim == 1 else found[..., None, None, :], *before)

    def mean_pays(self, shown: Array, users: Numbers) -> tuple[Array, Array]:
        """Expected mean outcome of each policy on `users` (...), and its variance, (..., n_policies) each.

        Of a law with a single type and spread.
        """
        law = self._after(of_users(shown, users)[..., None, None, :], *self._before)
        location, doubt, squares, freedom = (values[..., 0, 0] for values in law)
        variance = doubt * squares * (variance_factor(freedom) / freedom)
        return self.natural(location), self._stored(self.unit) ** 2 * variance

    def _after(self, moments: Array, location: Any, doubt: Any, weight: Any, freedom: Any) -> Posterior:
        """The law of pairs that have shown `moments` (..., 3), and had the other parameters before."""
        n, mean, squares = _parts(moments)
        grown, apart = 1 + n * doubt, mean - location
        doubt = doubt / grown
        around = n / grown * (apart * apart)
        around += squares
        around += weight
        moved = n * doubt * apart
        moved += location
        return Posterior(moved, doubt, around, freedom + n)

    def _shown_of(self, shown: Array, users: Numbers, policies: Numbers) -> Array:
        """The statistics of pairs of a user and a policy, (..., 3)."""
        return of_users(shown.reshape(-1, 3), users * self.n_policies + policies)

    def natural(self, values: Array, policies: Any = None) -> Array:
        """Means (..., n_policies), or (m, n_types) of `policies` (m,), in units of outcomes."""
        if self.dtype != np.float32:
            return values
        middle, unit = self._stored(self.middle), self._stored(self.unit)
        return (
            middle + unit * values if policies is None else middle[policies, None] + unit[policies, None] * values
        )

    def learn(self, shown: Array, users: Numbers, policies: Numbers, signals: Any) -> None:
        """Add outcomes of distinct users (Welford's update)."""
        n, mean, squares = _parts(self._shown_of(shown, users, policies))
        before = self._scaled(policies, signals) - mean
        after = n + 1
        shown[users, policies, 0] = after
        shown[users, policies, 1] = mean + before / after
        shown[users, policies, 2] = squares + before * before * (n / after)

    def fade(self, shown: Array, users: Numbers, keep: ArrayLike) -> None:
        """Let what distinct `users` have shown count `keep` (...) of what it did."""
        shown[users, :, self.amounts] *= self._stored(keep)[..., None, None]

    # ---- what rules read -----------------------------------------------------------------------------------

    def prediction(self, shown: Array, users: Numbers, log_weights: Array) -> "NormalRows":
        """The next outcome of `users`; `log_weights` (..., n_spreads) are log probabilities of their spreads."""
        return NormalRows(self, shown, users, log_weights)

    def bins(self, n_bins: int) -> tuple[Array, SignalTable]:
        """Cuts that tell the types apart, and the table between them, of users who have shown nothing."""
        if n_bins not in self._bins:
            variance = self.noise + self.of_runs + self.of_spread * self.spread.mean
            self._bins[n_bins] = normal_table(self.mean, np.sqrt(variance), n_bins)
        return self._bins[n_bins]

    def _scaled(self, policies: Numbers, signals: Any) -> Array:
        if self.dtype != np.float32:
            return signals
        scaled = (signals - self.middle[policies]) / self.unit[policies]
        return self._stored(np.clip(scaled, -FARTHEST, FARTHEST))

    def _stored(self, values: Any) -> Array:
        return np.asarray(values).astype(self.dtype, copy=False)


class NormalRows(NormalPrediction):
    """The next outcomes of users, each given what the user has shown; computed where they are read.

    Only pairs of a user and a policy that the user has shown an outcome of differ from the library's.
    """

    def __init__(self, law: NormalLaw, shown: Array, users: Numbers, log_weights: Array) -> None:
        self._law, self._shown, self._shape = law, shown, np.shape(users)
        self._users = np.atleast_1d(users)
        self._weights = np.exp(log_weights).astype(law.dtype, copy=False).reshape(len(self._users), -1)

    @property
    def n_types(self) -> int:
        return self._law.n_types

    @property
    def n_policies(self) -> int:
        return self._law.n_policies

    @cached_property
    def mean(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Expected mean outcome of each pair, (..., n_types, n_policies)."""
        return self._rows(self._law.mean, self._tried_mean)

    @cached_property
    def mean_variance(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Variance of each pair's mean outcome, (..., n_types, n_policies)."""
        spread = (self._weights @ self._law.spread.values)[:, None, None]
        return self._rows(self._law.of_runs + self._law.of_spread * spread, self._tried_variances[0])

    @cached_property
    def noise(self) -> Array:
        """Expected variance of each pair's outcomes around their mean, (..., n_types, n_policies)."""
        return self._rows(self._law.noise, self._tried_variances[1])

    @cached_property
    def deviation(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Standard deviation of the next outcome, (..., n_types, n_policies)."""
        return np.sqrt(self.mean_variance + self.noise)

    def mean_on(self, types: NDArray[np.int64]) -> Array:
        """Mean outcomes on a type for each user, (...) to (..., n_policies), without those on other types."""
        law, types = self._law, np.atleast_1d(types)
        untried = of_users(law.natural_mean_of_types, types)
        n, mean, _ = _parts(of_users(self._shown, self._users))
        # (n_types, n_spreads, n_policies), or (1, ...) where types are alike.
        doubt = law._before.doubt.T
        doubt = doubt if len(doubt) == 1 else doubt[types]
        pull = n[:, None] * doubt
        pull /= 1 + pull
        pull = pull[:, 0] if pull.shape[1] == 1 else (self._weights[:, :, None] * pull).sum(axis=1)
        found = law.natural(mean)
        found -= untried
        found *= pull
        found += untried
        return found.reshape(*self._shape, -1)

    def expected(self, belief: Array) -> Array:
        """Ũ(π) of beliefs (..., n_types), (..., n_policies)."""
        rows, policies = self._at
        flat = belief.reshape(len(self._users), -1)
        found = flat @ self._law.mean
        more = np.vecdot(flat[rows], self._tried_mean - self._law.natural_mean[policies])
        found[rows, policies] += more
        return found.reshape(*self._shape, -1)

    def cumulative(self, policy: int, values: Array) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), (n_types, n), as for `Prediction`: t, mixed by spread."""
        location, doubt, squares, freedom = self._law.posterior(policy, self._shown, self._users)
        gap = over_pairs(self._law._scaled(policy, values)) - location
        below = stdtr(np.minimum(freedom, LARGEST_FREEDOM), gap / np.sqrt(squares / freedom * (1 + doubt)))
        return (self._weights[:, :, None] * below).sum(axis=1).T

    def table(self, n_bins: int) -> SignalTable:
        """The next outcome in bins that tell the types apart; the bins are those of users who showed nothing."""
        cuts, table = self._law.bins(n_bins)
        deviation = np.sqrt(self._tried_variances[0] + self._tried_variances[1])
        probs = normal_probs(self._tried_mean, deviation, cuts.take(self._at[1], axis=0)[:, None])
        return table.replaced(self._shape, self._at, probs)

    @cached_property
    def _at(self) -> tuple[Array, Array]:
        """Row and policy, (m,) each, of the pairs of a user and a policy that the user has shown an outcome of."""
        rows, policies = self._shown[self._users, :, 0].nonzero()
        return rows, policies

    @cached_property
    def _tried(self) -> Posterior:
        rows, policies = self._at
        return self._law.posterior(policies, self._shown, self._users.take(rows))

    @cached_property
    def _tried_mean(self) -> Array:
        return self._law.natural(self._tried_location, self._at[1])

    @cached_property
    def _tried_location(self) -> Array:
        return self._mixed(self._tried.location)

    @cached_property
    def _tried_variances(self) -> tuple[Array, Array]:
        """Variance of the mean outcome of tried pairs, and of outcomes around it, (m, n_types) each."""
        location, doubt, squares, freedom = self._tried
        square = self._law.unit.take(self._at[1])[:, None] ** 2
        gap = location - self._tried_location[:, None]
        noise = variance_factor(freedom) / freedom * squares
        return square * self._mixed(doubt * noise + gap * gap), square * self._mixed(noise)

    def _mixed(self, values: Array) -> Array:
        """Expectation over the spreads of numbers of tried pairs, (m, n_spreads or 1, n_types) to (m, n_types)."""
        if values.shape[1] == 1:
            return values[:, 0]
        return np.matmul(self._weights.take(self._at[0], axis=0)[:, None], values)[:, 0]

    def _rows(self, untried: Array, tried: Array) -> Array:
        return filled(self._shape, self._at, untried, tried, self.n_policies)


def variance_factor(freedom: Array) -> Array:
    """Variance of a t distribution of scale 1, ν / (ν − 2) with ν − 2 at least `LEAST_FREEDOM`."""
    return 1 + 2 / np.maximum(freedom - 2, LEAST_FREEDOM)


def log_t_height(freedom: Any) -> Any:
    """Log density of Student's t at its location, scale 1, of degrees of freedom (...), to 1e-14."""
    if isinstance(freedom, float):
        return _stored_height(freedom)
    if freedom.size > FEW:
        return _height(freedom.astype(np.float64, copy=False))
    return np.array([_stored_height(value) for value in freedom.ravel().tolist()]).reshape(freedom.shape)


def _height(freedom: Any) -> Any:
    """log Γ(x + ½) − log Γ(x) − ½ log 2πx of x = ν / 2: by `SHIFT` steps Γ(x + 1) = x Γ(x), then by a series.

    Logarithms of large numbers, which would cancel, are left out.
    """
    x, grown, series = 0.5 * freedom, 1.0, 0.0
    for step in range(SHIFT):
        grown = grown * (x + step) / (x + (step + 0.5))
    inverse = 1 / (x + SHIFT)
    for term in _SERIES:
        series = series * (inverse * inverse) + term
    return np.log(grown * np.sqrt(1 + SHIFT / x)) + (series * inverse - 0.5 * log(2 * pi))


_stored_height = lru_cache(maxsize=4096)(_height)


def _alike(of_pairs: Array) -> Array:
    """(n_policies, n_types) as (n_policies, 1) where no policy's numbers differ between types."""
    return of_pairs[:, :1] if (of_pairs == of_pairs[:, :1]).all() else of_pairs


def _parts(moments: Array) -> tuple[Any, Any, Any]:
    """Number, mean and sum of squares of (..., 3); floats of a single pair."""
    return tuple(moments.tolist()) if moments.ndim == 1 else (moments[..., 0], moments[..., 1], moments[..., 2])


def spread_of_moments(moments: OutcomeMoments) -> Spread:
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
