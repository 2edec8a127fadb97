"""Bandits and Bayesian optimisation in the surveillance reserve, and the knowledge of each."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from lifelore.interaction import baselines
from lifelore.interaction.library.policy_library import PolicyLibrary

LENGTHS = 24
"""Lengths of the kernel that are compared, evenly in logarithm."""

GIVEN = {
    "UCB1": "each policy's mean pay over the types, worth one pull",
    "UCB1, tuned": "the same; tuned on these very tasks",
    "GP-UCB": "how alike policies did in training; β of Srinivas et al.",
    "GP-UCB, tuned": "the same; β tuned on these very tasks",
    "interval estimation": "each policy's mean and deviation over the types",
}
PEERS = tuple(GIVEN)
TUNING = {
    "UCB1, tuned": [
        {"exploration": c, "prior_pulls": pulls}
        for c in (0.0, 0.02, 0.05, 0.1, 0.2)
        for pulls in (0.1, 0.3, 1.0, 3.0)
    ],
    "GP-UCB, tuned": [{"beta": beta} for beta in (0.25, 1.0, 2.25, 4.0, 6.25, 9.0, 16.0)],
}
"""Settings that tuning tries: exploration constants on [0, 1] and weights of the prior means; constant β."""


def make_peer(
    name: str,
    library: PolicyLibrary,
    n_tasks: int,
    generator: np.random.Generator,
    kernel: NDArray[np.float64] | None,
    **tuned: float,
) -> baselines.Baseline:
    """A peer for `n_tasks` tasks at once, with its `kernel_of` the library and settings that tuning tries."""
    common = {"n_tasks": n_tasks, "seed": generator, **tuned}
    if name.startswith("GP-UCB"):
        return baselines.GPUCB.from_library(library, kernel=kernel, **{"beta": None, **common})
    if name == "interval estimation":
        return baselines.IntervalEstimation.from_library(library, **common)
    # Auer et al.'s algorithm is for payoffs in a known interval, which the library's bounds are.
    return baselines.UCB1.from_library(library, scale=library.performance.bounds(), **common)


def kernel_of(name: str, library: PolicyLibrary) -> NDArray[np.float64] | None:
    """The covariance that a Gaussian process takes from a library; None for peers that take none."""
    return performance_kernel(library.performance.mean) if name.startswith("GP-UCB") else None


def performance_kernel(mean: NDArray[np.float64]) -> NDArray[np.float64]:
    """deviation²·exp(-d²/2ℓ²) of the policies, (n_policies, n_policies), from mean pays (n_types, n_policies).

    The metric is not known and "is approximated from performance in the training tasks" (§4.6.4): d is the root
    mean square difference of two policies' pays over the types, the deviation that of pays about each policy's
    mean, and ℓ the most likely length if types are draws of the process with a hundredth of the deviation as
    noise. Lengths are from a tenth of the least positive distance to the largest.
    """
    centred, columns = mean - mean.mean(axis=0), mean.T
    deviation = float(np.sqrt((centred**2).mean()))
    gaps = np.sqrt(((columns[:, None, :] - columns[None, :, :]) ** 2).mean(axis=2))
    lengths = np.geomspace(gaps[gaps > 0].min() / 10, gaps.max(), LENGTHS)
    kernels = [deviation**2 * np.exp(-0.5 * (gaps / length) ** 2) for length in lengths]
    noise = (deviation / 100) ** 2 * np.eye(len(gaps))
    return max(kernels, key=lambda kernel: _log_density(kernel + noise, centred))


def _log_density(covariance: NDArray[np.float64], rows: NDArray[np.float64]) -> float:
    """Log density of all rows, up to a constant."""
    factor = cho_factor(covariance, lower=True)
    size = 2 * np.log(np.diag(factor[0])).sum()
    return float(-0.5 * (rows * cho_solve(factor, rows.T).T).sum() - 0.5 * len(rows) * size)
