"""Objects of a cloud without labels: the settings of a segmentation, and the labels that its method gives.

The methods have modules of their own: `convexity_segmentation`, `distance_segmentation`, `colour_segmentation`.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED
from lifelore.perception.segmentation.cut_confidence import CutCloud
from lifelore.perception.segmentation.outline import over_outline
from lifelore.perception.segmentation.range_noise import noise
from lifelore.perception.segmentation.table_evidence import REACH

METHODS = ("convexity", "clusters", "colour")
TABLE_BAND = 0.010
"""Metres; points no higher than this above the table, and no deeper below it, are the table."""
TOLERANCE = 0.012
"""Metres; points nearer than this are one object under ``"clusters"``."""
MIN_AREA = 6e-4
"""Square metres of surface below which a cluster or region is noise."""
STANDING = 0.25
"""Least share of an object's points over the visible table. Of one at its far end, only the front is over it."""
_FOOT = 0.03
"""Metres above the table up to which points are the foot of an object that stands on it."""
_FEW_LOW = 10
"""Least number of sampled points of such a foot."""
_BESIDE = 0.06
"""Metres from a foot at which the table would be seen, or an empty place."""
_HANGING = 0.2
"""Least share of the foot's points beside empty places, of a thing that is not on the table, as a chair."""
RISE = 1.5
"""Bands of noise (`range_noise`) above the table; an object of which less than that share is higher is noise."""

_SAMPLE = 20_000
"""Points on which the shares of objects are measured; small objects have some dozens of them."""


@dataclass(frozen=True)
class SegmentationSettings:
    """Settings of the segmentation of an unlabelled scene.

    Parameters
    ----------
    method : {"convexity", "clusters", "colour"}
        Surfaces that meet in creases are cut apart; Euclidean clusters; or the thesis's colour histogram
        (§2.3.3).
    colours : int
        Clusters of colour under ``"colour"``; the smallest is the background.
    """

    method: Literal["convexity", "clusters", "colour"] = "convexity"
    colours: int = 3

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise InputError(f"method must be one of {', '.join(METHODS)}, got {self.method!r}")
        if self.colours < 2:
            raise InputError(f"colours must be at least 2, got {self.colours}")


def cut_cloud(
    points: NDArray[np.float64],
    colours: NDArray[np.uint8] | None,
    settings: SegmentationSettings,
    camera: NDArray[np.float64] | None = None,
    empty: NDArray[np.float64] | None = None,
) -> CutCloud:
    """Labels of a scene in its own frame: 1 the table, 2 … objects by size, 0 the rest; ``"convexity"`` is sure to
    a degree.

    `camera` (3,), where known, tells ``"convexity"`` the outer side of each surface. `empty` (m, 2), where known,
    are places of the table's plane that the camera sees through: an object beside the visible table is kept where
    it reaches down to the plane and no such place is beside its feet.

    Raises
    ------
    InputError
        The colour method is asked for without colours.
    """
    labels = np.zeros(len(points), np.int64)
    labels[np.abs(points[:, 2]) <= TABLE_BAND] = TABLE
    above = np.flatnonzero((points[:, 2] > TABLE_BAND) & (points[:, 2] <= REACH))
    standing = points.take(above, axis=0)
    cut = _objects(standing, None if colours is None else colours[above], settings, camera, points)
    table = np.flatnonzero(labels == TABLE)
    few = slice(None, None, max(1, len(above) // _SAMPLE))
    some, outline = standing[few], points[table[:: max(1, len(table) // _SAMPLE)], :2]
    tests = [over_outline(some[:, :2], outline)]
    if empty is not None:
        beside = _stand(np.where(tests[0], UNLABELLED, cut.labels[few]), some, empty)
        tests[0] |= over_outline(some[:, :2], np.concatenate([outline, some[beside, :2]]))
    if camera is not None and len(table):
        tests.append(some[:, 2] > RISE * noise(some, camera))
    cut = _standing(cut, cut.labels[few], tests)
    labels[above] = cut.labels
    return replace(cut, labels=labels)


def _objects(
    points: NDArray[np.float64],
    colours: NDArray[np.uint8] | None,
    settings: SegmentationSettings,
    camera: NDArray[np.float64] | None,
    seen: NDArray[np.float64],
) -> CutCloud:
    """Labels of points above the table: 2 … objects by size, 0 the rest; `seen` are those of the table too."""
    if settings.method == "colour":
        from lifelore.perception.segmentation.colour_segmentation import colour_classes

        if colours is None:
            raise InputError("method=colour needs colours, and the cloud has none; use method=convexity")
        return CutCloud(colour_classes(points, colours, settings.colours))
    if settings.method == "clusters":
        from lifelore.perception.segmentation.distance_segmentation import euclidean_clusters

        return CutCloud(euclidean_clusters(points, TOLERANCE, MIN_AREA))
    from lifelore.perception.segmentation.convexity_segmentation import convex_objects

    return convex_objects(points, camera, MIN_AREA, seen)


def _stand(
    labels: NDArray[np.int64], points: NDArray[np.float64], empty: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n,) bool: points (n, 3) of objects that reach down to the table, with no `empty` places (m, 2) beside their
    feet. Such objects stand on the table, though it may not be seen around them."""
    from scipy.spatial import KDTree

    low = np.flatnonzero((points[:, 2] <= _FOOT) & (labels > TABLE))
    n = int(labels.max(initial=TABLE)) + 1
    feet = points[low, :2]
    if len(feet):
        near = np.abs(empty - (feet.min(axis=0) + feet.max(axis=0)) / 2) <= np.ptp(feet, axis=0) / 2 + _BESIDE
        empty = empty[near.all(axis=1)]
    bare = KDTree(empty).query(feet, distance_upper_bound=_BESIDE)[0] < np.inf
    n_feet, n_bare = (np.bincount(labels[rows], minlength=n) for rows in (low, low[bare]))
    return ((n_feet >= _FEW_LOW) & (n_bare < _HANGING * n_feet))[labels]


def _standing(cut: CutCloud, labels: NDArray[np.int64], shares: Iterable[NDArray[np.bool_]]) -> CutCloud:
    """The objects of which at least `STANDING` of the points are in each of `shares`, numbered again.

    `labels` (m,) and the shares (m,) are those of a sample of the points.
    """
    n = int(cut.labels.max(initial=TABLE)) + 1
    counts = np.maximum(np.bincount(labels, minlength=n), 1)
    keep = np.arange(n) > TABLE
    for share in shares:
        keep &= np.bincount(labels[share], minlength=n) >= STANDING * counts
    kept = np.flatnonzero(keep)
    number = np.full(n, UNLABELLED, np.int64)
    number[kept] = np.arange(2, 2 + len(kept))
    confidence = {int(number[label]): sure for label, sure in cut.confidence.items() if number[label]}
    return replace(cut, labels=number[cut.labels], confidence=confidence)
