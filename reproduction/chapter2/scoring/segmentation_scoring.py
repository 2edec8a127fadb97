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
    """A true object beside its best segments.

    points : int, number of points of the object
    iou : float, largest intersection over union with a segment, in 0–1
    right, wrong : int, points of the object, and other points, in the segment that holds most of the object
    """

    points: int
    iou: float
    right: int
    wrong: int


def overlaps(truth: NDArray[np.int64], labels: NDArray[np.int64]) -> list[ObjectOverlap]:
    """Each true object of a scene beside its best segments.

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
    kept = segments > TABLE
    shared, of_segment = shared[:, kept], of_segment[kept]
    return [_overlap(int(of_object[i]), shared[i], of_segment) for i, label in enumerate(objects) if label > TABLE]


def _overlap(points: int, shared: NDArray[np.int64], sizes: NDArray[np.int64]) -> ObjectOverlap:
    if not shared.any():
        return ObjectOverlap(points, 0.0, 0, 0)
    most = int(shared.argmax())
    right = int(shared[most])
    return ObjectOverlap(
        points, float((shared / (points + sizes - shared)).max()), right, int(sizes[most]) - right
    )
