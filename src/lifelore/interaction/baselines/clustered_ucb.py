"""Two-level UCB1: select a cluster of similar policies, then a policy of the cluster (Pandey et al., 2007)."""

from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.arm_statistics import ArmStatistics
from lifelore.interaction.baselines.baseline import Baseline, library_moments
from lifelore.interaction.baselines.ucb1 import checked_exploration, checked_scale, to_unit, upper_bounds
from lifelore.interaction.selection.choice import choose

if TYPE_CHECKING:
    from lifelore.interaction.library.policy_library import PolicyLibrary

REPRESENTATIVES = ("mean", "max")


class ClusteredUCB(Baseline):
    """UCB1 over clusters, each a single arm, then UCB1 within the selected cluster.

    Parameters
    ----------
    clusters : (n_policies,) int
        The cluster of each policy, numbered from 0 without gaps.
    representative : {"mean", "max"}
        A cluster's payoff: the mean of all its plays, or the mean of its best played policy. Its pulls are the sum
        over its policies.
    exploration, scale, prior_means, prior_pulls
        As in `UCB1`, on both levels.
    n_policies, n_tasks, seed
        As in `Baseline`.

    `from_library` clusters policies with similar payoffs over the library's types, see `clusters_of_policies`.
    Thesis: §4.7.2.

    Examples
    --------
    >>> player = ClusteredUCB(4, clusters=[0, 0, 1, 1], prior_means=[0.5, 0.4, 0.1, 0.6], exploration=0)
    >>> player.select()
    0
    """

    name: ClassVar[str] = "clustered-ucb"

    def __init__(
        self,
        n_policies: int,
        *,
        clusters: ArrayLike,
        representative: str = "mean",
        exploration: float = 1.0,
        scale: tuple[float, float] | None = None,
        prior_means: ArrayLike | None = None,
        prior_pulls: ArrayLike = 1.0,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        if representative not in REPRESENTATIVES:
            raise InputError(f"representative must be one of {', '.join(REPRESENTATIVES)}, got {representative!r}")
        self.representative = representative
        self.exploration, self.scale = checked_exploration(exploration), checked_scale(scale)
        self.clusters = _checked_clusters(clusters, n_policies)
        self._members = self.clusters == np.arange(self.clusters.max() + 1)[:, None]
        means = None if prior_means is None else to_unit(np.asarray(prior_means, np.float64), self.scale)
        self.arms = ArmStatistics.from_prior(self.rows, n_policies, means, prior_pulls)

    @classmethod
    def from_library(cls, library: "PolicyLibrary", **settings: Any) -> Self:
        """Prior means, scale and clusters from the library; `settings` override."""
        known: dict[str, Any] = {
            "prior_means": library_moments(library).mean,
            "scale": library.performance.bounds(),
        }
        if "clusters" not in settings:
            known["clusters"] = clusters_of_policies(library.performance.mean)
        return cls(library.n_policies, **(known | settings))

    def _choose(self) -> NDArray[np.int64]:
        """A cluster by its representative, then a policy of it."""
        chosen = choose(upper_bounds(*self._representatives(), self.exploration), self._generator)
        members = self._members[chosen]
        pulls = np.where(members, self.arms.pulls, 0.0)
        bounds = upper_bounds(pulls, self.arms.mean, self.exploration)
        return choose(np.where(members, bounds, -np.inf), self._generator)

    def _scores(self) -> NDArray[np.float64]:
        raise NotImplementedError("two levels have no single score for a policy")

    def _representatives(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Pulls and mean of each cluster, (rows, n_clusters)."""
        pulls = self.arms.pulls @ self._members.T
        if self.representative == "mean":
            paid = (self.arms.pulls * self.arms.mean) @ self._members.T
            return pulls, paid / np.where(pulls > 0, pulls, 1.0)
        played = np.where(self.arms.pulls > 0, self.arms.mean, -np.inf)
        best = np.where(self._members, played[:, None, :], -np.inf).max(axis=2)
        return pulls, np.where(pulls > 0, best, 0.0)

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        self.arms.add(policies, to_unit(rewards, self.scale))


def clusters_of_policies(mean: ArrayLike, n_clusters: int | None = None) -> NDArray[np.int64]:
    """Clusters of policies with similar payoffs over the types, (n_policies,) int from 0, by Ward's hierarchy.

    Parameters
    ----------
    mean : (n_types, n_policies) float
    n_clusters : int, optional
        Default ⌈√n_policies⌉, which makes both levels about equally long.
    """
    columns = np.asarray(mean, np.float64).T
    n_policies = len(columns)
    wanted = int(np.ceil(np.sqrt(n_policies))) if n_clusters is None else n_clusters
    if not 1 <= wanted <= n_policies:
        raise InputError(f"n_clusters must lie between 1 and {n_policies}, got {n_clusters}")
    if n_policies == 1:
        return np.zeros(1, np.int64)
    from scipy.cluster.hierarchy import fcluster, linkage

    labels = fcluster(linkage(columns, "ward"), wanted, "maxclust")
    return np.unique(labels, return_inverse=True)[1].astype(np.int64)


def _checked_clusters(clusters: ArrayLike, n_policies: int) -> NDArray[np.int64]:
    labels = np.asarray(clusters)
    if labels.shape != (n_policies,) or labels.dtype.kind not in "iu":
        raise InputError(f"clusters must be {n_policies} whole numbers, got shape {labels.shape}")
    if not np.array_equal(np.unique(labels), np.arange(labels.max() + 1)):
        raise InputError("clusters must be numbered from 0 without gaps")
    return labels.astype(np.int64)
