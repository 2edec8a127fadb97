"""Peers: two other methods that name the relations of pairs of objects; they describe each near pair by vectors.

*Boxes*: a rule on axis-aligned boxes, as many systems ship it. *Histograms* over all pairs of points, in the style
of Fichtl et al. (ICRA 2014), read by randomised trees: for every point of one object and every point of the other
the elevation of their displacement over the horizontal, and its length, counted in two dimensions. Heading is left
out, so a turned table changes nothing.
"""

from collections.abc import Callable, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, NONE, ON, SYMMETRIC, PairLabel
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS
from lifelore.perception.contacts.near_pairs import NearPair, near_pairs, split_objects
from lifelore.perception.pairs.directed_label import LEAST_CONFIDENCE, REVERSED, mirror_order, mirrored, pair_class
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation import PairBelief, Relation
from reproduction.chapter2.scenes.perturbation import without_table

TOLERANCE = 0.02
"""Metres by which an object may start below the top of its support, or above the table."""
OVERLAP = 0.15
"""Least share of the smaller ground plan inside the other for one object to be above the other."""
GRAIN = 0.015
"""Side of the voxels in metres; clouds are thinned before histograms, since all pairs of points are counted."""
ELEVATION_BINS = 12
DISTANCE_EDGES = np.array([0.0, 0.02, 0.04, 0.07, 0.11, 0.16, 0.23, 0.32, np.inf])
"""Metres, finer where objects meet."""
TREES = 100
Points = NDArray[np.float64]


def pairs_of_objects(cloud: LabelledCloud) -> list[NearPair]:
    """The near pairs of objects of a scene at the default settings."""
    settings = DEFAULT_CONTACT_SETTINGS
    thin = voxelised(without_table(cloud), settings.voxel)
    return list(near_pairs(split_objects(thin), settings.near, settings.table_margin)) if thin.objects else []


def described(pairs: Sequence[NearPair], describe: Callable[[Points, Points], Points]) -> ScenePairs:
    """Near pairs as a classifier sees them: a row ``describe(a, b)`` and a row ``describe(b, a)`` of each."""
    ends = [(a, b) for pair in pairs for a, b in ((pair.first, pair.second), (pair.second, pair.first))]
    labels = np.array([(a.label, b.label) for a, b in ends], np.int64).reshape(-1, 2)
    rows = np.array([describe(a.points, b.points) for a, b in ends])
    return ScenePairs(PairFeatures((), rows, labels, np.repeat([pair.gap for pair in pairs], 2)), ())


def boxes(first: Points, second: Points) -> Points:
    """Bottom and top of either, metres, and the share of the smaller ground plan in common; shape ``(5,)``.

    Heights from the 1st to the 99th percentile.
    """
    heights = [np.quantile(points[:, 2], [0.01, 0.99]) for points in (first, second)]
    low = np.array([points[:, :2].min(axis=0) for points in (first, second)])
    high = np.array([points[:, :2].max(axis=0) for points in (first, second)])
    common = np.maximum(high.min(axis=0) - low.max(axis=0), 0).prod()
    return np.array([*heights[0], *heights[1], common / max((high - low).prod(axis=1).min(), 1e-12)])


def orientation_histogram(first: Points, second: Points) -> Points:
    """Shares of point pairs by elevation and distance, flat ``(ELEVATION_BINS * 8,)``, sums to 1."""
    coarse = [
        voxelised(LabelledCloud(points, np.ones(len(points), np.int64)), GRAIN).points
        for points in (first, second)
    ]
    offset = coarse[0][:, None] - coarse[1][None]
    distance = np.linalg.norm(offset, axis=-1).ravel()
    elevation = np.arcsin(np.clip(offset[..., 2].ravel() / np.maximum(distance, 1e-12), -1, 1))
    row = np.clip(((elevation / np.pi + 0.5) * ELEVATION_BINS).astype(np.int64), 0, ELEVATION_BINS - 1)
    column = np.searchsorted(DISTANCE_EDGES, distance, side="right") - 1
    bins = len(DISTANCE_EDGES) - 1
    count = np.bincount(row * bins + column, minlength=ELEVATION_BINS * bins)
    return count / count.sum()


class BoundingBoxRule:
    """Relations read off axis-aligned boxes.

    The boxes' ground plans overlap, and one starts no lower than `TOLERANCE` under the top of the other: on. They
    overlap without that, and one hangs higher than `TOLERANCE` over the table: both. Otherwise adjacent up to
    `ADJACENT_GAP`, else none.
    """

    describe = staticmethod(boxes)

    def fit(self, scenes: Sequence[ScenePairs], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """Nothing is learnt."""
        return self

    def predict(self, scene: ScenePairs) -> tuple[Relation, ...]:
        """The relation of every near pair, each with confidence 1."""
        rows, gaps = scene.features.matrix[::2].tolist(), scene.features.gaps[::2].tolist()
        return _likeliest(scene, [{_by_boxes(row, gap): 1.0} for row, gap in zip(rows, gaps, strict=True)])


class OrientationTrees:
    """Randomised trees on the histogram.

    Every labelled pair is a training row in both orders, so that the trees cannot learn which object a file names
    first. A prediction adds the shares of both orders.
    """

    describe = staticmethod(orientation_histogram)

    def fit(self, scenes: Sequence[ScenePairs], truths: Sequence[Sequence[PairLabel]]) -> Self:
        """Learn from described scenes and the labels of their pairs."""
        from sklearn.ensemble import ExtraTreesClassifier

        rows, names = [], []
        for scene, truth in zip(scenes, truths, strict=True):
            for at, labels in enumerate(scene.labels(truth, LEAST_CONFIDENCE)):
                if labels:
                    name = pair_class(labels, int(scene.features.pairs[2 * at, 0]), SYMMETRIC)
                    rows += list(scene.features.matrix[2 * at : 2 * at + 2])
                    names += [name, mirrored(name, SYMMETRIC)]
        self._trees: Any = ExtraTreesClassifier(TREES, random_state=0).fit(np.array(rows), np.array(names))
        return self

    def predict(self, scene: ScenePairs) -> tuple[Relation, ...]:
        """The relation of every near pair."""
        if not len(scene.features.pairs):
            return ()
        shares, classes = self._trees.predict_proba(scene.features.matrix), self._trees.classes_.tolist()
        both = (shares[::2] + shares[1::2][:, mirror_order(classes, SYMMETRIC)]) / 2
        return _likeliest(scene, [dict(zip(classes, own, strict=True)) for own in both.tolist()])


def _likeliest(scene: ScenePairs, shares: Sequence[dict[str, float]]) -> tuple[Relation, ...]:
    ends = zip(scene.features.pairs[::2].tolist(), scene.features.gaps[::2].tolist(), shares, strict=True)
    return tuple(PairBelief(a, b, gap, own).best() for (a, b), gap, own in ends)


def _by_boxes(row: Sequence[float], gap: float) -> str:
    bottom, top, other_bottom, other_top, overlap = row
    if overlap >= OVERLAP:
        if bottom >= other_top - TOLERANCE:
            return ON
        if other_bottom >= top - TOLERANCE:
            return REVERSED + ON
        if max(bottom, other_bottom) > TOLERANCE:
            return BOTH if bottom > other_bottom else REVERSED + BOTH
    return ADJACENT if gap <= ADJACENT_GAP else NONE
