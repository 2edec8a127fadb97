"""Overlap of the true objects of a scene with the segments that were found.

Only points with a true label count. The table is no object, but its points count as false in an object's segment.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, UNLABELLED

FOUND = 0.5
"""Least IoU of an object that counts as found."""


class ObjectOverlap(NamedTuple):
    """A true object: the number of its points, and the largest intersection over union with a segment, in 0–1."""

    points: int
    iou: float


def overlaps(truth: NDArray[np.int64], labels: NDArray[np.int64]) -> list[ObjectOverlap]:
    """Each true object of a scene beside its best segment.

    Parameters
    ----------
    truth, labels : (n,) int64
        True and found labels as in `LabelledCloud`; points whose true label is 0 do not count.
    """
    known = truth != UNLABELLED
    objects, row = np.unique(truth[known], return_inverse=True)
    segments, column = np.unique(labels[known], return_inverse=True)
    shared = np.zeros((len(objects), len(segments)), np.int64)
    np.add.at(shared, (row, column), 1)
    of_object, of_segment = shared.sum(axis=1), shared.sum(axis=0)
    iou = (shared / (of_object[:, None] + of_segment - shared))[:, segments > TABLE].max(axis=1, initial=0.0)
    best = zip(objects, of_object.tolist(), iou.tolist(), strict=True)
    return [ObjectOverlap(points, own) for label, points, own in best if label > TABLE]
