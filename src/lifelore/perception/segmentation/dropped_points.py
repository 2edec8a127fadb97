"""Points over a table, or beside it, that became no object: how many, and where."""

import numpy as np

from lifelore.core.labelled_cloud import TABLE, UNLABELLED
from lifelore.perception.segmentation.outline import over_outline
from lifelore.perception.segmentation.range_noise import band
from lifelore.perception.segmentation.region import OVERHANG
from lifelore.perception.segmentation.table_evidence import REACH
from lifelore.perception.segmentation.table_frame import SegmentedScene

_FEW = 100
_FEW_SHARE = 0.05
"""Of the points above the table's plane; at most 0.3 % are dropped from clouds that show a table alone."""


def dropped_points(scene: SegmentedScene) -> str | None:
    """A warning of many points that became no object; None where they are few, or where labels were given.

    Counted are points up to `REACH` above the table that lie over the outline of the table and the objects, or
    within `OVERHANG` of it. Walls and furniture further away are rightly dropped.
    """
    points, labels, camera = scene.cloud.points, scene.cloud.labels, scene.cloud.camera
    if not scene.automatic or scene.table is None:
        return None
    is_above = points[:, 2] > band(points, camera)
    above = points[is_above & (labels == UNLABELLED) & (points[:, 2] < REACH)]
    if len(above) < _FEW:
        return None
    known = points[labels >= TABLE, :2]
    dropped = above[over_outline(above[:, :2], known[:: max(1, len(known) // 5000)], OVERHANG)]
    n_above = len(dropped) + int(np.count_nonzero(is_above & (labels > TABLE)))
    if len(dropped) < max(_FEW, _FEW_SHARE * n_above):
        return None
    low, high = np.percentile(dropped, (5, 95), axis=0)
    place = ", ".join(f"{axis} {a:.2f} to {b:.2f}" for axis, a, b in zip("xyz", low, high, strict=True))
    return (
        f"{len(dropped):,} of {n_above:,} points above the table's plane ({100 * len(dropped) / n_above:.0f} %)"
        f" belong to no object: {place} m in the scene's frame; if objects stand there, pass --up X,Y,Z or"
        " crop the cloud (--roi)"
    )
