"""GP-UCB: upper confidence bounds from a Gaussian process over policies (Srinivas et al., 2010).

The process is over finitely many policies, so its posterior is exact linear algebra. With L the Cholesky factor of
the covariance of all payoffs so far and V = L⁻¹ K(seen, all), the posterior mean is m + Vᵀ z with z = L⁻¹ (y - m)
and the variance is diag K - Σ V². Each payoff appends a row to L, V and z; this row of L is a column of V.
"""

from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.baselines.baseline import Baseline, library_moments, row_of
from lifelore.interaction.baselines.policy_kernels import performance_kernel, prior_covariance
from lifelore.interaction.library.policy_library import PolicyLibrary

KERNELS = ("performance", "covariance")
MOST_ROWS = 4
"""Largest number of rows of V, in multiples of n_policies; the posterior then becomes the prior and V is empty."""


class GPUCB(Baseline):
    """Posterior mean + √β_t · posterior deviation.

    Parameters
    ----------
    kernel : (n_policies, n_policies) float
        Covariance of the policies' mean payoffs, see `policy_kernels`.
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

    `from_library` takes ``kernel="performance"`` (how alike policies did in training), ``"covariance"`` (over the
    library's types), or an array of the caller's own metric; means and noise under G₀.
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
        # Of each task from the first fold on, till then shared by all: (1 or rows, n_policies, n_policies).
        self._covariance = self.kernel[None]
        self._mean = np.tile(row_of("prior_means", prior_means, n_policies), (self.rows, 1))
        self._variance = np.tile(np.diag(self.kernel), (self.rows, 1))
        self._seen = 0
        self._rows = np.empty((self.rows, 8, n_policies))

    @classmethod
    def from_library(cls, library: PolicyLibrary, *, kernel: Any = "performance", **settings: Any) -> Self:
        """Kernel, means and noise from the library; `settings` override."""
        return super().from_library(library, kernel=_kernel_of(library, kernel), **settings)

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Means and noise under the library's prior."""
        mean, _, noise = library_moments(library)
        return {"prior_means": mean, "noise": float(np.sqrt((noise**2).mean()))}

    def posterior(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Mean and deviation of each policy's mean payoff, (rows, n_policies) each."""
        return self._mean.copy(), np.sqrt(np.maximum(self._variance, 0.0))

    def _beta(self) -> float:
        if self.beta is not None:
            return self.beta
        t = self.episode + 1
        return max(0.0, 2 * np.log(self.n_policies * t**2 * np.pi**2 / (6 * self.delta)))

    def _scores(self) -> NDArray[np.float64]:
        mean, deviation = self.posterior()
        return mean + np.sqrt(self._beta()) * deviation

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        """Append a row to V; the mean already contains z."""
        every = np.arange(self.rows)
        known = self._rows[:, : self._seen]
        # The new row of L: L⁻¹ K(seen, policy), which is the policy's column of V.
        column = known[every, :, policies]
        prior = self._covariance[every if len(self._covariance) > 1 else 0, policies]
        corner = np.sqrt(self._variance[every, policies].clip(0.0) + self.noise**2)
        row = (prior - np.einsum("rs,rsp->rp", column, known)) / corner[:, None]
        # z's new entry is (y - posterior mean) / corner: the payoff's surprise in its own deviations.
        self._mean += row * ((rewards - self._mean[every, policies]) / corner)[:, None]
        self._variance -= row**2
        self._append(row)

    def _append(self, row: NDArray[np.float64]) -> None:
        if self._seen == self._rows.shape[1]:
            room = np.empty((self.rows, 2 * self._seen, self.n_policies))
            room[:, : self._seen] = self._rows
            self._rows = room
        self._rows[:, self._seen] = row
        self._seen += 1
        if self._seen >= max(MOST_ROWS * self.n_policies, 32):
            self._fold()

    def _fold(self) -> None:
        """Make the posterior the prior: exact, and it bounds the time of a step."""
        known = self._rows[:, : self._seen]
        self._covariance = self._covariance - np.einsum("rsp,rsq->rpq", known, known, optimize=True)
        self._rows, self._seen = np.empty((self.rows, 8, self.n_policies)), 0


def _kernel_of(library: PolicyLibrary, kernel: Any) -> NDArray[np.float64]:
    if not isinstance(kernel, str):
        return np.asarray(kernel, np.float64)
    if kernel == "performance":
        return performance_kernel(library.performance.mean)
    if kernel == "covariance":
        return prior_covariance(library)
    raise NotFoundError(f"kernel must be one of {', '.join(KERNELS)}, or an array, got {kernel!r}")


def _checked_kernel(kernel: ArrayLike, n_policies: int) -> NDArray[np.float64]:
    matrix = np.array(kernel, np.float64)
    if matrix.shape != (n_policies, n_policies) or not np.isfinite(matrix).all():
        raise InputError(f"kernel must be {n_policies} × {n_policies} and finite, got shape {matrix.shape}")
    if not np.allclose(matrix, matrix.T, rtol=1e-9, atol=1e-12 * np.abs(matrix).max()):
        raise InputError("kernel must be symmetric")
    least = np.linalg.eigvalsh(matrix)[0]
    if least < -1e-8 * max(np.abs(matrix).max(), 1e-300) * n_policies:
        raise InputError(f"kernel must be positive semidefinite, its least eigenvalue is {least:.3g}")
    return matrix
