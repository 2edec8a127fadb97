"""Relations found without labels: pairs that look alike get one name, rel 0, rel 1, … (thesis §2.3.5).

The thesis proposes X-means on the displacements between contact points. Its spheres of one size fit what
displacements look like badly, so a better discovery stands beside it: a mixture of Gaussians of any shape on the
direction of the contact, the gap and how much of one object stands over the other. The number of parts is
chosen by the integrated completed likelihood (Biernacki, Celeux, Govaert 2000), which asks for parts that are
apart, not for a good fit alone.
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
LIKENESS = ("elevation_0", "normal_up_0", "gap", "a_over_b")
LEAST_GAP = 0.003
"""Metres. Gaps enter by their logarithm, and below it they are all contact."""
ROUGHNESS = 1e-2
"""Added to each part's variances (the columns have variance 1), so that none closes in on a few equal rows."""
STARTS = 3


@dataclass(frozen=True, eq=False)
class Discovery:
    """What was found.

    Parameters
    ----------
    labels : (n,) int64
        The relation of each pair, in 0 … n_relations - 1, the most frequent first.
    scenes : (n,) int64
        Which of the given scenes each pair is of.
    pairs : (n, 2) int64
        The pair (a, b) in that scene, a the one whose centre is higher.
    """

    labels: NDArray[np.int64]
    scenes: NDArray[np.int64]
    pairs: NDArray[np.int64]

    @property
    def n_relations(self) -> int:
        """How many relations were found."""
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
    """The better discovery: a mixture of Gaussians; arguments and errors as in `discover_by_displacement`."""
    from sklearn.mixture import GaussianMixture
    from threadpoolctl import threadpool_limits

    scenes, pairs, rows = upright_rows(features, LIKENESS)
    if len(rows) == 1:
        return Discovery(np.zeros(1, np.int64), scenes, pairs)
    gap = LIKENESS.index("gap")
    rows[:, gap] = np.log(np.maximum(rows[:, gap], LEAST_GAP))
    spread = rows.std(axis=0)
    rows = (rows - rows.mean(axis=0)) / np.where(spread > 0, spread, 1.0)
    seed = int(rng.integers(2**31))
    # No more parts than there are different rows; matrices this small gain nothing by threads.
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

    Of the two orders of a pair one has to be chosen, or every relation with a direction would be found twice.
    """
    scenes, pairs, rows = [], [], []
    for number, scene in enumerate(features):
        rise = scene.columns(["centre_rise"])[:, 0]
        table = (scene.pairs == TABLE).any(axis=1)
        upper = np.zeros(len(rise), bool)
        upper[0::2], upper[1::2] = rise[0::2] >= 0, rise[0::2] < 0
        kept = upper & ~table
        scenes.append(np.full(kept.sum(), number))
        pairs.append(scene.pairs[kept])
        rows.append(scene.columns(names)[kept])
    if not sum(map(len, rows)):
        raise InputError("features must hold at least one pair of near objects, got none")
    return np.concatenate(scenes).astype(np.int64), np.concatenate(pairs), np.concatenate(rows)


def _completed_criterion(model, rows: NDArray[np.float64]) -> float:
    """Bayesian criterion plus twice the entropy of the parts' shares in each row; smaller is better."""
    shares = model.predict_proba(rows)
    return float(model.bic(rows) - 2 * (shares * np.log(np.maximum(shares, 1e-300))).sum())


def _by_size(labels: NDArray[np.integer]) -> NDArray[np.int64]:
    """Clusters numbered anew, the largest first; of equal ones, the one that occurs first."""
    _, first, member, count = np.unique(labels, return_index=True, return_inverse=True, return_counts=True)
    rank = np.empty(len(count), np.int64)
    rank[np.lexsort((first, -count))] = np.arange(len(count))
    return rank[member]
