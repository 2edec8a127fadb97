"""GP-UCB: upper confidence bounds from a Gaussian process over policies (Srinivas et al., 2010).

The process is over finitely many policies, so that each payoff y of a policy i changes its mean m and covariance K
exactly: with k = K[i] and s = K[i, i] + noise², m ← m + k (y − m[i]) / s and K ← K − k kᵀ / s.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.baseline import Baseline, library_moments, row_of
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.outcome_rows import numbers


class GPUCB(Baseline):
    """Posterior mean + √β_t · posterior deviation.

    Parameters
    ----------
    kernel : (n_policies, n_policies) float
        Covariance of the policies' mean payoffs.
    noise : float
        Deviation > 0 of a payoff about its mean.
    prior_means : float or (n_policies,) float
        Mean of the process.
    beta : float, optional
        Constant β ≥ 0. Default: Srinivas et al.'s β_t = 2 ln(n_policies t² π² / (6 δ)), t from 1.
    delta : float
        δ in (0, 1) of that.
    n_policies, n_tasks, seed
        As in `Baseline`.

    `from_library` gives the covariance over the library's types, means and noise, all under G₀. Of a single type
    the covariance is 0: its means are taken as known, and the best of them is played for ever.
    Thesis: §4.6.4, §4.7.3, Fig. 4.11.

    Examples
    --------
    >>> player = GPUCB(2, kernel=[[1.0, 0.5], [0.5, 1.0]], noise=0.5)
    >>> player.update(0, 2.0)
    >>> player.posterior()[0].round(2).tolist()
    [[1.6, 0.8]]
    """

    name: ClassVar[str] = "gp-ucb"

    def __init__(
        self,
        n_policies: int,
        *,
        kernel: ArrayLike,
        noise: float,
        prior_means: ArrayLike = 0.0,
        beta: float | None = None,
        delta: float = 0.1,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        self.kernel = _checked_kernel(kernel, n_policies)
        if not (noise > 0 and np.isfinite(noise)):
            raise InputError(f"noise must be finite and positive, got {noise}")
        if beta is not None and not (beta >= 0 and np.isfinite(beta)):
            raise InputError(f"beta must be finite and at least 0, got {beta}")
        if not 0 < delta < 1:
            raise InputError(f"delta must lie between 0 and 1, got {delta}")
        self.noise, self.beta, self.delta = float(noise), beta, delta
        self._covariance = np.tile(self.kernel, (self.rows, 1, 1))
        self._mean = np.tile(row_of("prior_means", prior_means, n_policies), (self.rows, 1))

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Covariance, means and noise under the library's prior."""
        mean, _, noise = library_moments(library)
        apart = np.asarray(library.performance.mean) - mean
        kernel = (apart * np.asarray(library.prior)[:, None]).T @ apart
        return {"kernel": kernel, "prior_means": mean, "noise": float(np.sqrt((noise**2).mean()))}

    def posterior(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Mean and deviation of each policy's mean payoff, (rows, n_policies) each."""
        variance = np.diagonal(self._covariance, axis1=1, axis2=2)
        return self._mean.copy(), np.sqrt(np.maximum(variance, 0.0))

    def _beta(self) -> float:
        if self.beta is not None:
            return self.beta
        t = self.episode + 1
        return max(0.0, 2 * np.log(self.n_policies * t**2 * np.pi**2 / (6 * self.delta)))

    def _scores(self) -> NDArray[np.float64]:
        mean, deviation = self.posterior()
        return mean + np.sqrt(self._beta()) * deviation

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        every = np.arange(self.rows)
        column = self._covariance[every, policies]
        square = np.maximum(column[every, policies], 0.0) + self.noise**2
        self._mean += column * ((rewards - self._mean[every, policies]) / square)[:, None]
        self._covariance -= column[:, :, None] * (column / square[:, None])[:, None, :]


def _checked_kernel(kernel: ArrayLike, n_policies: int) -> NDArray[np.float64]:
    matrix = numbers(kernel, f"kernel must be {n_policies} × {n_policies} and finite").copy()
    if matrix.shape != (n_policies, n_policies) or not np.isfinite(matrix).all():
        raise InputError(f"kernel must be {n_policies} × {n_policies} and finite, got shape {matrix.shape}")
    if not np.allclose(matrix, matrix.T, rtol=1e-9, atol=1e-12 * np.abs(matrix).max()):
        raise InputError("kernel must be symmetric")
    least = np.linalg.eigvalsh(matrix)[0]
    if least < -1e-8 * max(np.abs(matrix).max(), 1e-300) * n_policies:
        raise InputError(f"kernel must be positive semidefinite, its least eigenvalue is {least:.3g}")
    return matrix
