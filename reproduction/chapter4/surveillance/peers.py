"""Bandits and Bayesian optimisation in the surveillance reserve, and the knowledge of each method."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction import baselines
from lifelore.interaction.baselines.policy_kernels import metric_kernel, performance_kernel, prior_covariance
from lifelore.interaction.library.policy_library import PolicyLibrary

MEANS = "each policy's mean pay over the library's types"
GIVEN = {
    "UCB1": f"{MEANS}, worth one pull; the range of pays",
    "UCB1, flat": "the range of pays",
    "UCB1, tuned": f"{MEANS}; tuned on these very tasks",
    "GP-UCB": "how alike policies did in training; β of Srinivas et al.",
    "GP-UCB, tuned": "how alike policies did in training; β tuned on these very tasks",
    "GP-UCB, prior covariance": "pays' covariance over the library's types; β tuned on these very tasks",
    "GP-UCB, true metric": "the targets' true distances; kernel and β tuned on these very tasks",
    "interval estimation": "each policy's mean and deviation over the library's types, worth two pulls",
    "eps-greedy on means": f"{MEANS}, worth one pull; ε = 0.1",
    "clustered UCB": "clusters of policies that did alike in training, their means; the range of pays",
    "Thompson": "each policy's mean and deviation over the library's types; the noise",
    "EXP-3": "the range of pays; an episode is one payoff",
    "try all": "nothing",
}
PEERS = tuple(GIVEN)
TRUE_METRIC = "GP-UCB, true metric"
GP_PEERS = tuple(name for name in PEERS if name.startswith("GP-UCB"))

UCB_GRID = tuple((c, pulls) for c in (0.0, 0.02, 0.05, 0.1, 0.2) for pulls in (0.1, 0.3, 1.0, 3.0))
"""Exploration constants on [0, 1] and weights of the prior means that tuning tries."""
BETA_GRID = (0.25, 1.0, 2.25, 4.0, 6.25, 9.0, 16.0)
LENGTH_GRID = (1.0, 2.0, 3.0, 5.0)
DEVIATION = 80.0
"""Of a policy's mean pay before anything was seen, in the kernel on true distances."""


FROM_LIBRARY = {
    "UCB1": baselines.UCB1,
    "interval estimation": baselines.IntervalEstimation,
    "eps-greedy on means": baselines.EpsilonGreedyMeans,
    "clustered UCB": baselines.ClusteredUCB,
    "Thompson": baselines.GaussianThompson,
    "try all": baselines.TryAll,
}
"""Peers without settings of their own."""


def make_peer(
    name: str,
    library: PolicyLibrary,
    world: Surveillance,
    n_tasks: int,
    n_episodes: int,
    generator: np.random.Generator,
    kernel: NDArray[np.float64] | None = None,
    **tuned: float,
) -> baselines.Baseline:
    """A peer for `n_tasks` tasks at once.

    `kernel` is `kernel_of` the library, to be made once where several settings are tried; `tuned` are settings
    found by tuning, else the middle of their grid.
    """
    common = {"n_tasks": n_tasks, "seed": generator}
    if name in FROM_LIBRARY:
        return FROM_LIBRARY[name].from_library(library, **common)
    if name == "UCB1, tuned":
        settings = {"exploration": 0.02, "prior_pulls": 1.0} | tuned
        return baselines.UCB1.from_library(library, **settings, **common)
    scale = library.performance.bounds()
    if name == "UCB1, flat":
        return baselines.UCB1(library.n_policies, scale=scale, **common)
    if name == "EXP-3":
        return baselines.EXP3(library.n_policies, horizon=n_episodes, scale=scale, **common)
    if name == TRUE_METRIC:
        distance = world.distance(world.targets)
        kernel = metric_kernel(distance, length=tuned.get("length", 2.0), deviation=DEVIATION)
    covariance = kernel_of(name, library) if kernel is None else kernel
    beta = None if name == "GP-UCB" else tuned.get("beta", 1.0)
    return baselines.GPUCB.from_library(library, kernel=covariance, beta=beta, **common)


def kernel_of(name: str, library: PolicyLibrary) -> NDArray[np.float64] | None:
    """The covariance that a Gaussian process takes from a library; None for peers that take none."""
    if name not in GP_PEERS or name == TRUE_METRIC:
        return None
    if name.endswith("covariance"):
        return prior_covariance(library)
    return performance_kernel(library.performance.mean)


def tuning_grid(name: str) -> list[dict[str, float]]:
    """Settings that tuning tries; a single empty set where there is nothing to tune."""
    if name == "UCB1, tuned":
        return [{"exploration": c, "prior_pulls": pulls} for c, pulls in UCB_GRID]
    if name == TRUE_METRIC:
        return [{"length": length, "beta": beta} for length in LENGTH_GRID for beta in BETA_GRID]
    if name in ("GP-UCB, tuned", "GP-UCB, prior covariance"):
        return [{"beta": beta} for beta in BETA_GRID]
    return [{}]
