"""Segmentation by distance: Euclidean clusters of points.

Two objects that touch are one cluster; the thesis (§2.5) argues that later steps must tolerate such errors.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.clouds.voxel import voxels_of
from lifelore.perception.segmentation.cut_confidence import labels_by_size

_MAX_VOXELS = 200_000


def euclidean_clusters(points: NDArray[np.float64], tolerance: float, min_area: float) -> NDArray[np.int64]:
    """(n,) int64: 2 the largest set of points linked by steps of at most `tolerance`, 3 the next, 0 noise.

    The points are thinned to voxels of half the tolerance first; an area is counted in occupied voxels. A scene
    of more than 200,000 such voxels is cut at a coarser tolerance, so that memory stays bounded.
    """
    from scipy.spatial import KDTree

    if len(points) == 0:
        return np.empty(0, np.int64)
    thin = voxels_of(points, tolerance / 2)
    while len(thin.counts) > _MAX_VOXELS:
        tolerance *= 2
        thin = voxels_of(points, tolerance / 2)
    pairs = KDTree(thin.means).query_pairs(tolerance, output_type="ndarray")
    component = connected_parts(pairs, len(thin.counts))
    label = labels_by_size(np.bincount(component) * (tolerance / 2) ** 2, min_area)
    return label[component][thin.inverse]
