"""The law of numbers whose mean outcomes are jointly normal over policies: what one policy shows tells of others.

    u ~ N(μ_τ, Σ)  the mean outcomes of a user of type τ      outcome = u_π + noise, N(0, v_π)

After n_π outcomes with mean x̄_π, u is normal again. With R = diag √(n / v) and K Kᵀ = I + R Σ R:

    E[u]  = μ_τ + G r      G = Σ R K⁻ᵀ,  r = K⁻¹ R (x̄ − μ_τ)          cov u = Σ − G Gᵀ

The covariance is the same for all types. Only policies that the user has tried have a row in K, so the time
depends on their number. K has no singular value below 1: Σ may be singular. The formulas are those of Gaussian
process regression over policies (Rasmussen and Williams 2006, §2.2).
"""

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import informative_cuts, normal_probs
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.law import Law, Numbers
from lifelore.interaction.outcomes.outcome_rows import finite_outcomes
from lifelore.interaction.outcomes.prediction import NormalPrediction
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[Any]

AT_ONCE = 1 << 21
"""Size of the largest temporary array."""
LOG_2_PI = float(np.log(2 * np.pi))


class Tried(NamedTuple):
    """What users have tried, of covariance Σ; m is the largest number of policies that a user of these has tried.

    places : (k, m) int64, policies; those beyond the user's own have the root 0
    root : (k, m), √(n / v)
    inverse : (k, m, m), K⁻¹
    """

    places: NDArray[np.int64]
    root: Array
    inverse: Array

    @classmethod
    def of(cls, weight: Array, covariance: Array) -> "Tried":
        """Of weights n / v (k, n_policies) and the covariance (n_policies, n_policies)."""
        m = max(1, int((weight > 0).sum(axis=1).max(initial=0)))
        places = np.argsort(weight <= 0, axis=1, kind="stable")[:, :m]
        root = np.sqrt(np.take_along_axis(weight, places, axis=1))
        whole = covariance[places[:, :, None], places[:, None, :]] * root[:, :, None] * root[:, None, :]
        return cls(places, root, np.linalg.inv(np.linalg.cholesky(whole + np.eye(m))))

    def residual(self, scaled: Array, mean: Array) -> Array:
        """r, (k, n_types, m), of ``scaled`` = R x̄ (k, m) and means (n_types, n_policies)."""
        gap = scaled[:, None] - self.root[:, None] * np.moveaxis(mean[:, self.places], 0, 1)
        return gap @ self.inverse.transpose(0, 2, 1)

    def gain(self, covariance: Array, policies: Array) -> Array:
        """Gᵀ of some policies (k, q), (k, m, q)."""
        return self.inverse @ (self.root[:, :, None] * covariance[self.places[:, :, None], policies[:, None, :]])


class JointNormalLaw(Law):
    """P(number | type, policy) given what each user has shown.

    Parameters
    ----------
    mean : (n_types, n_policies) float
    covariance : (n_policies, n_policies) float
    deviation : (n_policies,) float
        Of a user's outcomes around the user's own mean.
    dtype : {"f8", "f4"}
        Precision of the statistics and of the likelihoods.
    """

    amounts = 0

    def __init__(self, mean: Array, covariance: Array, deviation: Array, dtype: str = "f8") -> None:
        self.spread, self.dtype = Spread.known(0.0), np.dtype(dtype)
        self.n_types, self.n_policies = mean.shape
        self.shape = (self.n_policies, 2)  # number and sum of outcomes
        # Inside, outcomes are in deviations from the middle of the types' means: noise has the variance 1.
        self.middle, self.unit = mean.mean(axis=0), deviation.copy()
        self.mean = (mean - self.middle) / self.unit
        self.covariance = covariance / np.outer(self.unit, self.unit)
        self._bins: dict[int, Array] = {}

    # ---- the law of signals --------------------------------------------------------------------------------

    def checked(self, signals: Any) -> Array:
        """Finite numbers (k,)."""
        return finite_outcomes(signals)

    def log_likelihoods(
        self, policies: Numbers, signals: Any, shown: Array | None = None, users: Numbers = None
    ) -> Array:
        """Log densities of outcomes (...) given what `users` (...) have shown, (..., 1, n_types)."""
        if shown is None:
            location, variance = self.mean.T[policies], np.diag(self.covariance)[policies]
        else:
            of_users = np.atleast_1d(users)
            of_policies = np.broadcast_to(policies, of_users.shape)[:, None]
            location, variance = self.posterior(shown, of_users, of_policies)
            location = location[..., 0].reshape(*np.shape(users), -1)
            variance = variance.reshape(np.shape(users))
        square = 1 + np.asarray(variance)[..., None]
        gap = ((signals - self.middle[policies]) / self.unit[policies])[..., None] - location
        height = np.log(square) + np.log(self.unit[policies] ** 2)[..., None] + LOG_2_PI
        return (-0.5 * (height + gap * gap / square))[..., None, :].astype(self.dtype)

    def posterior(self, shown: Array, users: Array, policies: Array | None = None) -> tuple[Array, Array]:
        """Means (k, n_types, q) and variances (k, q) of `users` (k,) with `policies` (k, q), in units of noise.

        By default of all policies.
        """
        policies = self._every(len(users)) if policies is None else policies
        location = np.moveaxis(self.mean[:, policies], 0, 1).copy()
        variance = np.diag(self.covariance)[policies]
        for rows, tried, scaled, gain in self.blocks(shown, users, policies):
            location[rows] += tried.residual(scaled, self.mean) @ gain
            variance[rows] -= (gain * gain).sum(axis=1)
        return location, np.maximum(variance, 0.0)

    def blocks(self, shown: Array, users: Array, policies: Array) -> Iterator[tuple[slice, Tried, Array, Array]]:
        """Rows of `users` (k,), what these have tried, R x̄ (rows, m), and Gᵀ of their `policies` (k, q)."""
        step = max(1, AT_ONCE // self.n_policies**2)
        for start in range(0, len(users), step):
            rows = slice(start, start + step)
            number, total = np.moveaxis(shown[users[rows]].astype(np.float64), -1, 0)
            tried = Tried.of(number, self.covariance)
            scaled = np.take_along_axis(total, tried.places, axis=1) / np.where(tried.root > 0, tried.root, 1.0)
            yield rows, tried, scaled, tried.gain(self.covariance, policies[rows])

    def _every(self, n_users: int) -> Array:
        return np.broadcast_to(np.arange(self.n_policies), (n_users, self.n_policies))

    def learn(self, shown: Array, users: Numbers, policies: Numbers, signals: Any) -> None:
        """Add outcomes of distinct users."""
        scaled = (signals - self.middle[policies]) / self.unit[policies]
        shown[users, policies] += np.stack([np.ones_like(scaled), scaled], axis=-1).astype(self.dtype)

    # ---- what rules read -----------------------------------------------------------------------------------

    def prediction(self, shown: Array, users: Numbers, log_weights: Array) -> "JointNormalRows":
        """The next outcome of `users`; `log_weights` are of a single spread, and ignored."""
        return JointNormalRows(self, shown, users)

    def cuts(self, n_bins: int) -> Array:
        """Cuts that tell the types apart, of users who have shown nothing."""
        if n_bins not in self._bins:
            deviation = np.sqrt(1 + np.diag(self.covariance)) * self.unit
            mean = self.middle + self.unit * self.mean
            self._bins[n_bins] = informative_cuts(mean, np.broadcast_to(deviation, mean.shape), n_bins)
        return self._bins[n_bins]

    def restore(self, shown: Array, user: int, state: Mapping[str, Array]) -> None:
        """Take over a `state`; InputError where it is of another law."""
        if "policies" in state:
            raise InputError("this state has means in place of sums, as before version 4; begin a new session")
        super().restore(shown, user, state)


class JointNormalRows(NormalPrediction):
    """The next outcomes of users, each given what the user has shown; computed where they are read."""

    def __init__(self, law: JointNormalLaw, shown: Array, users: Numbers) -> None:
        self._law, self._shown, self._shape = law, shown, np.shape(users)
        self._users = np.atleast_1d(users)

    @cached_property
    def mean(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Expected mean outcome of each pair, (..., n_types, n_policies)."""
        return self._natural(self._posterior[0])

    @cached_property
    def mean_variance(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Variance of each pair's mean outcome, (..., n_types, n_policies)."""
        variance = self._posterior[1].reshape(*self._shape, 1, -1) * self._law.unit**2
        return np.broadcast_to(variance, self.mean.shape)

    @cached_property
    def deviation(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Standard deviation of the next outcome, (..., n_types, n_policies)."""
        return np.sqrt(self.mean_variance + self._law.unit**2)

    def table(self, n_bins: int) -> SignalTable:
        """The next outcome in bins that tell the types apart; the bins are those of users who showed nothing."""
        return SignalTable(normal_probs(self.mean, self.deviation, self._law.cuts(n_bins)))

    @cached_property
    def _posterior(self) -> tuple[Array, Array]:
        return self._law.posterior(self._shown, self._users)

    def _natural(self, scaled: Array) -> Array:
        return (self._law.middle + self._law.unit * scaled).reshape(*self._shape, *scaled.shape[1:])
