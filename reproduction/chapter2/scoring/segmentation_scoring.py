"""Accuracy of segmentations: weighted overlap, over- and under-segmentation, and objects found.

Only points with a true label count. The table is no object, but its points count as false in an object's segment.
The weighted overlap is the mean over object points of the intersection over union (IoU) of their object with its
best segment. Over- and under-segmentation follow Richtsfeld et al. (2012): an object is matched with the segment
that holds most of its points; F_os is the share of object points outside the matched segment, and F_us is the
number of other points in matched segments per object point. An object is *found* if its best IoU is at least 0.5.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED
from lifelore.core.metrics import Estimate, ratio_estimate
from reproduction.chapter2.scoring.relation_scoring import share_over_scenes

FOUND = 0.5
"""Least IoU of an object that counts as found."""


@dataclass(frozen=True)
class ObjectOverlap:
    """A true object beside its best segments.

    Parameters
    ----------
    label : int
        Of the object, 2 and above.
    points : int
        Number of points of the object.
    iou : float
        Largest IoU with a segment, in 0–1.
    segment : int
        The segment of this IoU; 0 where no segment has a point of the object.
    right, wrong : int
        Points of the object, and other points, in the segment that holds most of the object.
    """

    label: int
    points: int
    iou: float
    segment: int
    right: int
    wrong: int

    @property
    def found(self) -> bool:
        """Whether the IoU is at least `FOUND`."""
        return self.iou >= FOUND


@dataclass(frozen=True)
class SegmentationScore:
    """Measures over scenes, with 95 % intervals from resampled scenes; `found` counts objects."""

    weighted_overlap: Estimate
    over: Estimate
    under: Estimate
    found: Estimate


def overlaps(truth: NDArray[np.int64], labels: NDArray[np.int64]) -> list[ObjectOverlap]:
    """Each true object of a scene beside its best segments.

    Parameters
    ----------
    truth, labels : (n,) int64
        True and found labels as in `LabelledCloud`; points whose true label is 0 do not count.

    Raises
    ------
    InputError
        The two differ in length.
    """
    if truth.shape != labels.shape:
        raise InputError(f"truth and labels must be of the same length, got {len(truth)} and {len(labels)}")
    known = truth != UNLABELLED
    objects, row = np.unique(truth[known], return_inverse=True)
    segments, column = np.unique(labels[known], return_inverse=True)
    shared = np.zeros((len(objects), len(segments)), np.int64)
    np.add.at(shared, (row, column), 1)
    of_object, of_segment = shared.sum(axis=1), shared.sum(axis=0)
    kept = segments > TABLE
    shared, segments, of_segment = shared[:, kept], segments[kept], of_segment[kept]
    return [
        _overlap(int(label), int(of_object[i]), segments, shared[i], of_segment)
        for i, label in enumerate(objects)
        if label > TABLE
    ]


def _overlap(
    label: int, points: int, segments: NDArray[np.int64], shared: NDArray[np.int64], sizes: NDArray[np.int64]
) -> ObjectOverlap:
    if not shared.any():
        return ObjectOverlap(label, points, 0.0, 0, 0, 0)
    ious = shared / (points + sizes - shared)
    best, most = int(ious.argmax()), int(shared.argmax())
    right = int(shared[most])
    return ObjectOverlap(label, points, float(ious[best]), int(segments[best]), right, int(sizes[most]) - right)


def matched_objects(found: Sequence[ObjectOverlap]) -> dict[int, int]:
    """The true object of each segment that finds an object; no segment finds two, as their IoU is at least 0.5.

    Of two objects with an IoU of exactly 0.5 with a segment, the first counts.
    """
    matched: dict[int, int] = {}
    for overlap in found:
        if overlap.found:
            matched.setdefault(overlap.segment, overlap.label)
    return matched


def segmentation_score(scenes: Sequence[Sequence[ObjectOverlap]]) -> SegmentationScore:
    """The measures over the objects of all scenes together.

    Raises
    ------
    InputError
        No scene has an object.
    """
    scenes = [scene for scene in scenes if scene]
    if not scenes:
        raise InputError("scenes must hold at least one object")
    points = np.array([sum(o.points for o in scene) for scene in scenes], float)
    weighted = np.array([sum(o.iou * o.points for o in scene) for scene in scenes])
    right = np.array([sum(o.right for o in scene) for scene in scenes], float)
    wrong = np.array([sum(o.wrong for o in scene) for scene in scenes], float)
    found = [sum(o.found for o in scene) for scene in scenes]
    return SegmentationScore(
        ratio_estimate(weighted, points),
        ratio_estimate(points - right, points),
        ratio_estimate(wrong, points),
        share_over_scenes(found, [len(scene) for scene in scenes]),
    )
