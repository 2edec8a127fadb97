"""Points over a table, or beside it, that became no object: how many, and where."""

import numpy as np
from numpy.typing import NDArray

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
    side = "" if camera is None else f"{_side(dropped.mean(axis=0), known.mean(axis=0), camera)} of the table, "
    return (
        f"{len(dropped):,} of {n_above:,} points above the table's plane ({100 * len(dropped) / n_above:.0f} %)"
        f" belong to no object: {side}{place} m in the scene's frame; if objects stand there, pass --up X,Y,Z or"
        " crop the cloud (--roi)"
    )


def _side(place: NDArray[np.float64], middle: NDArray[np.float64], camera: NDArray[np.float64]) -> str:
    """Where a place (3,) lies from the `middle` (2,) of the table, as the camera sees it."""
    forward = (middle - camera[:2]) / max(float(np.linalg.norm(middle - camera[:2])), 1e-9)
    offset = place[:2] - middle
    away, right = float(offset @ forward), float(offset @ [forward[1], -forward[0]])
    if abs(away) > abs(right):
        return "at the back" if away > 0 else "at the front"
    return "on the right" if right > 0 else "on the left"
