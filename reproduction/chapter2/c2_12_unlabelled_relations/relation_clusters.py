"""Clusters of pairs found without labels, and their agreement with the labels.

Each pair counts once for X-means as the thesis proposes it, for k-means with the true number of relations, and for
our discovery; *every word* clusters all displacements between contact points, in three dimensions and in the order
in which A and B were given. Thesis: §2.3.5.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, CORE_RELATIONS
from lifelore.core.streams import stream
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.relations.discovery import DISPLACEMENT, discover, discover_by_displacement, upright_rows
from lifelore.perception.relations.x_means import x_means
from reproduction.chapter2.scenes.tabletop_pairs import Row
from reproduction.chapter2.scoring.pair_validation import Reading, as_scene, joined_displacements

X_MEANS, PRINTED, K_MEANS, OURS = "x-means", "x-means, printed", "k-means", "lifelore"
MOST = 10
"""Most clusters that may be found."""
RESAMPLES = 400
Labels = NDArray[np.int64]
Names = NDArray[np.str_]


@dataclass(frozen=True, eq=False)
class Sighted:
    """The n near pairs of a data set, the object with the higher centre first.

    `displacements` are ``(n, 2)``: to the right as the camera sees it, and up, metres.
    """

    scenes: Names
    relations: Names
    features: list[PairFeatures]
    displacements: NDArray[np.float64]

    @property
    def sides(self) -> Names:
        """The relations, with *adjacent* divided into left and right."""
        side = np.where(self.displacements[:, 0] < 0, "left", "right")
        return np.where(self.relations == ADJACENT, side, self.relations)


def sighted(rows: Sequence[Row]) -> Sighted:
    """The near pairs of some rows; there must be one."""
    near = [row for row in rows if row["gap"] is not None]
    features = [as_scene(row).features for row in near]
    return Sighted(
        np.array([row["scene"] for row in near]),
        np.array([row["relation"] for row in near]),
        features,
        upright_rows(features, DISPLACEMENT)[2],
    )


def k_means(points: NDArray[np.float64], k: int, rng: np.random.Generator) -> Labels:
    """scikit-learn's, the best of ten starts."""
    from sklearn.cluster import KMeans

    k = min(k, len(np.unique(points, axis=0)))
    model = KMeans(k, n_init=10, random_state=int(rng.integers(2**31)))  # type: ignore[arg-type]
    return model.fit_predict(points).astype(np.int64)


METHODS: dict[str, Callable[[Sighted, np.random.Generator], Labels]] = {
    X_MEANS: lambda seen, rng: discover_by_displacement(seen.features, rng, most=MOST).labels,
    PRINTED: lambda seen, rng: discover_by_displacement(seen.features, rng, most=MOST, formula="printed").labels,
    K_MEANS: lambda seen, rng: k_means(seen.displacements, len(set(seen.relations)), rng),
    OURS: lambda seen, rng: discover(seen.features, rng, most=MOST).labels,
}
"""Name → the cluster of each near pair."""


def clustered(seen: Sighted, method: str, starts: int, name: str) -> list[Labels]:
    """Clusters of a data set called `name` from several random starts."""
    # With matrices of four rows, threads mostly wait for each other.
    with threadpool_limits(1):
        return [METHODS[method](seen, stream(start, "relation clusters", method, name)) for start in range(starts)]


def rand_index(relations: Names, labels: Labels) -> float:
    """Adjusted Rand index: 1 where clusters are the relations, 0 as good as chance."""
    from sklearn.metrics import adjusted_rand_score

    return float(adjusted_rand_score(relations, labels))


def cluster_counts(relations: Names, labels: Labels) -> list[list[int]]:
    """Of each cluster, how many pairs of each of `CORE_RELATIONS`; the largest cluster first."""
    counts = [[int(((labels == k) & (relations == name)).sum()) for name in CORE_RELATIONS] for k in set(labels)]
    return sorted(counts, key=lambda row: (-sum(row), row))


def cluster_names(relations: Names, labels: Labels) -> Names:
    """The most frequent relation of each pair's cluster; among equals the first of `CORE_RELATIONS`."""
    named = np.empty(len(labels), dtype="<U16")
    for k in np.unique(labels):
        own = relations[labels == k]
        named[labels == k] = max(CORE_RELATIONS, key=lambda name: int((own == name).sum()))
    return named


def rand_index_by_scene(scenes: Names, relations: Names, labels: Labels) -> Estimate:
    """Adjusted Rand index of one data set; scenes resampled (percentiles), the clusters as they are."""
    value = rand_index(relations, labels)
    groups = [np.flatnonzero(scenes == name) for name in np.unique(scenes)]
    rng = stream(len(groups), "rand index resampled")
    drawn = []
    for _ in range(RESAMPLES):
        at = np.concatenate([groups[k] for k in rng.integers(len(groups), size=len(groups))])
        drawn.append(rand_index(relations[at], labels[at]))
    low, high = np.quantile(drawn, [0.025, 0.975])
    return Estimate(value, value, (float(low), float(high)), len(relations))


def every_word(rows: Sequence[Row], reading: Reading, name: str) -> dict | None:
    """All displacements in three dimensions, A and B given: their number, and the ARI of X-means and k-means.

    ``{"displacements", "clusters", "ari_x_means", "ari_k_means"}``; None where there is no displacement.
    """
    moved, owner = joined_displacements(rows, reading.kernel, reading.drop)
    if not len(moved):
        return None
    relations = np.array([row["relation"] for row in rows])[owner]
    rng = stream(0, "every word", name)
    found = x_means(moved, rng, most=min(MOST, len(moved)))
    with threadpool_limits(1):
        k_clusters = k_means(moved, len(set(relations)), rng)
    return {
        "displacements": len(moved),
        "clusters": len(found.centres),
        "ari_x_means": rand_index(relations, found.labels),
        "ari_k_means": rand_index(relations, k_clusters),
    }
