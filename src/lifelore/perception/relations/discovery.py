"""Discovery of relations without labels: clusters of similar pairs (thesis §2.3.5).

The thesis proposes X-means on the displacements between contact points. Its spheres of equal size fit
displacements poorly. `discover` uses a mixture of Gaussians of any shape on the direction of the contact, the gap
and the overlap seen from above. The number of parts is chosen by the integrated completed likelihood (Biernacki,
Celeux, Govaert 2000), which prefers separated parts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.relations.x_means import Formula, x_means

DISPLACEMENT = ("contact_right", "rise_0")
"""The displacement as the camera sees it, sideways and up: the plane of the thesis's Figure 2.4; metres."""
FEATURES = ("elevation_0", "normal_up_0", "gap", "a_over_b")
LEAST_GAP = 0.003
"""Metres. Gaps enter by their logarithm, and below it they are all contact."""
ROUGHNESS = 1e-2
"""Added to each part's variances (the columns have variance 1), so that none closes in on a few equal rows."""
STARTS = 3


@dataclass(frozen=True, eq=False)
class Discovery:
    """Clusters of pairs, the discovered relations.

    Parameters
    ----------
    labels : (n,) int64
        The relation of each pair, in 0 … n_relations - 1, the most frequent first.
    scenes : (n,) int64
        Index of the scene of each pair.
    pairs : (n, 2) int64
        The pair (a, b) in that scene, a the one whose centre is higher.
    """

    labels: NDArray[np.int64]
    scenes: NDArray[np.int64]
    pairs: NDArray[np.int64]

    @property
    def n_relations(self) -> int:
        """Number of relations."""
        return int(self.labels.max()) + 1


def discover_by_displacement(
    features: Sequence[PairFeatures], rng: np.random.Generator, *, most: int = 10, formula: Formula = "corrected"
) -> Discovery:
    """The thesis's proposal: X-means on displacements, pairs of objects only.

    Parameters
    ----------
    features : sequence of PairFeatures
        One of each scene.
    rng : numpy Generator
    most : int
        Most relations to be found, ≥ 1.
    formula : {"corrected", "printed"}
        Of the criterion, see `x_means.bayesian_criterion`.

    Raises
    ------
    InputError
        The scenes hold no two near objects.
    """
    scenes, pairs, rows = upright_rows(features, DISPLACEMENT)
    found = x_means(rows, rng, most=min(most, len(rows)), formula=formula)
    return Discovery(_by_size(found.labels), scenes, pairs)


def discover(features: Sequence[PairFeatures], rng: np.random.Generator, *, most: int = 10) -> Discovery:
    """Discovery by a mixture of Gaussians; arguments and errors as in `discover_by_displacement`."""
    from sklearn.mixture import GaussianMixture
    from threadpoolctl import threadpool_limits

    scenes, pairs, rows = upright_rows(features, FEATURES)
    if len(rows) == 1:
        return Discovery(np.zeros(1, np.int64), scenes, pairs)
    gap = FEATURES.index("gap")
    rows[:, gap] = np.log(np.maximum(rows[:, gap], LEAST_GAP))
    spread = rows.std(axis=0)
    rows = (rows - rows.mean(axis=0)) / np.where(spread > 0, spread, 1.0)
    seed = int(rng.integers(2**31))
    # At most as many parts as different rows; threads do not speed up matrices this small.
    largest = min(most, max(1, len(rows) // 2), len(np.unique(rows, axis=0)))
    with threadpool_limits(limits=1):
        models = [
            GaussianMixture(parts, reg_covar=ROUGHNESS, n_init=STARTS, max_iter=500, random_state=seed).fit(rows)
            for parts in range(1, largest + 1)
        ]
    best = min(models, key=lambda model: _completed_criterion(model, rows))
    return Discovery(_by_size(best.predict(rows)), scenes, pairs)


def upright_rows(
    features: Sequence[PairFeatures], names: Sequence[str]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Scene, pair and columns of every two near objects, each pair once: the one with the higher centre first.

    With both orders of a pair, every directed relation would be found twice.
    """
    scenes, pairs, rows = [], [], []
    for number, scene in enumerate(features):
        rise = scene.columns(["centre_rise"])[:, 0]
        table = (scene.pairs == TABLE).any(axis=1)
        upper = np.zeros(len(rise), bool)
        upper[0::2], upper[1::2] = rise[0::2] >= 0, rise[0::2] < 0
        chosen = upper & ~table
        scenes.append(np.full(chosen.sum(), number))
        pairs.append(scene.pairs[chosen])
        rows.append(scene.columns(names)[chosen])
    if not sum(map(len, rows)):
        raise InputError("features must hold at least one pair of near objects, got none")
    return np.concatenate(scenes).astype(np.int64), np.concatenate(pairs), np.concatenate(rows)


def _completed_criterion(model, rows: NDArray[np.float64]) -> float:
    """Bayesian criterion plus twice the entropy of the parts' shares in each row; smaller is better."""
    shares = model.predict_proba(rows)
    return float(model.bic(rows) - 2 * (shares * np.log(np.maximum(shares, 1e-300))).sum())


def _by_size(labels: NDArray[np.integer]) -> NDArray[np.int64]:
    """Clusters renumbered by size, largest first; of equal ones, the first to occur."""
    _, first, member, count = np.unique(labels, return_index=True, return_inverse=True, return_counts=True)
    rank = np.empty(len(count), np.int64)
    rank[np.lexsort((first, -count))] = np.arange(len(count))
    return rank[member]
