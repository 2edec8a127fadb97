"""Covariances between policies, for Gaussian processes over a finite set of policies.

Two sources of similarity: performance in training, and a true metric that the caller knows. Thesis: §4.6.4 (the
metric is not known and "is approximated from performance in the training tasks").
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

JITTER = 1e-10
"""Share of the mean variance added to the diagonal, so that a factorisation exists."""


def performance_distances(mean: ArrayLike) -> NDArray[np.float64]:
    """Root mean square difference of two policies' mean payoffs over the types, (n_policies, n_policies).

    Parameters
    ----------
    mean : (n_types, n_policies) float
    """
    columns = np.asarray(mean, np.float64).T
    if columns.ndim != 2 or not np.isfinite(columns).all():
        raise InputError("mean must be (n_types, n_policies), finite")
    squares = ((columns[:, None, :] - columns[None, :, :]) ** 2).mean(axis=2)
    return np.sqrt(squares)


def metric_kernel(distances: ArrayLike, *, length: float, deviation: float = 1.0) -> NDArray[np.float64]:
    """deviation²·exp(-d²/2ℓ²), made positive semidefinite; (n_policies, n_policies).

    The Gaussian form of a metric that is not Euclidean (grid steps, largest coordinate) need not be a covariance:
    negative eigenvalues are then set to 0 and the diagonal is restored.

    Parameters
    ----------
    distances : (n_policies, n_policies) float
        Symmetric, at least 0, 0 on the diagonal.
    length : float
        ℓ > 0, in units of the distances.
    deviation : float
        Prior deviation of a policy's mean payoff, > 0.
    """
    gaps = np.asarray(distances, np.float64)
    square = gaps.ndim == 2 and gaps.shape[0] == gaps.shape[1] and gaps.size > 0
    if not square or not np.isfinite(gaps).all() or (gaps < 0).any():
        raise InputError("distances must be (n_policies, n_policies), finite and at least 0")
    if not np.allclose(gaps, gaps.T, rtol=1e-9, atol=1e-12) or np.diag(gaps).any():
        raise InputError("distances must be symmetric and 0 on the diagonal")
    if not (length > 0 and deviation > 0):
        raise InputError(f"length and deviation must be positive, got {length} and {deviation}")
    return deviation**2 * _semidefinite(np.exp(-0.5 * (gaps / length) ** 2))


def performance_kernel(mean: ArrayLike) -> NDArray[np.float64]:
    """`metric_kernel` on the policies' training performance, as in the thesis's GP-UCB.

    Its length is the most likely length given the types' payoffs, see `likeliest_length`; its deviation the root
    mean square deviation of payoffs about each policy's mean over types.

    Raises
    ------
    InputError
        `mean` is no finite (n_types, n_policies) array, or no policy's payoff differs between types.
    """
    table = np.asarray(mean, np.float64)
    gaps = performance_distances(table)
    centred = table - table.mean(axis=0)
    deviation = float(np.sqrt((centred**2).mean()))
    if not deviation > 0:
        raise InputError("mean must differ between types for at least one policy; give a kernel of another metric")
    length = likeliest_length(gaps, centred, deviation)
    return metric_kernel(gaps, length=length, deviation=deviation)


def likeliest_length(distances: ArrayLike, centred: ArrayLike, deviation: float) -> float:
    """The most likely length of a kernel if the rows of `centred` are draws of the process.

    Of 24 lengths, evenly in logarithm, from a tenth of the least positive distance to the largest; 1 where all
    distances are 0. Draws have noise about the process, a hundredth of `deviation`.

    Parameters
    ----------
    distances : (n_policies, n_policies) float
    centred : (n_types, n_policies) float
        Payoffs less each policy's mean.
    deviation : float
        Deviation of the kernel, > 0.
    """
    gaps, rows = np.asarray(distances, np.float64), np.asarray(centred, np.float64)
    apart = gaps[gaps > 0]
    if not apart.size:
        return 1.0
    lengths = np.geomspace(apart.min() / 10, apart.max(), 24)
    noise = (deviation / 100) ** 2 * np.eye(len(gaps))
    fits = [_log_density(metric_kernel(gaps, length=each, deviation=deviation) + noise, rows) for each in lengths]
    return float(lengths[np.argmax(fits)])


def _log_density(covariance: NDArray[np.float64], rows: NDArray[np.float64]) -> float:
    """Log density of all rows, up to a constant."""
    from scipy.linalg import cho_factor, cho_solve

    factor = cho_factor(covariance, lower=True)
    size = 2 * np.log(np.diag(factor[0])).sum()
    return float(-0.5 * (rows * cho_solve(factor, rows.T).T).sum() - 0.5 * len(rows) * size)


def _semidefinite(like: NDArray[np.float64]) -> NDArray[np.float64]:
    """The correlation matrix with negative eigenvalues set to 0 and the diagonal at 1."""
    values, vectors = np.linalg.eigh(like)
    if values[0] >= -JITTER * len(like):
        return like
    positive = (vectors * np.maximum(values, 0.0)) @ vectors.T
    scale = np.sqrt(np.diag(positive))
    return positive / np.outer(scale, scale)
