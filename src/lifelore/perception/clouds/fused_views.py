"""Several views of one scene as one cloud in the first view's frame."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.voxel import VOXEL, voxelised


def fused(views: Sequence[PointCloud], poses: NDArray[np.float64], size: float = VOXEL) -> PointCloud:
    """The measured points of all views, one a voxel and label, in the frame of the first view.

    Parameters
    ----------
    views : sequence of PointCloud
        At least one, each with a measured point. Labels name the same objects in all views.
    poses : (k, 4, 4) float64
        From the frame of each view to a frame that all share.
    size : float
        Side of a voxel, metres.

    Returns
    -------
    PointCloud
        Not organised; name and time of the frame are the first view's. `camera` is that of the first view that
        names its camera, `other_cameras` are those of the others. Labels and colours exist if every view has them.

    Raises
    ------
    InputError
        Only some views have labels, a view has no measured point, or numbers of views and poses differ.
    """
    if not views or poses.shape != (len(views), 4, 4):
        raise InputError(f"poses must have shape ({len(views)}, 4, 4) for {len(views)} views, got {poses.shape}")
    labelled = [view.is_labelled for view in views]
    if any(labelled) and not all(labelled):
        raise InputError(
            f"views must all have labels or none, but only {sum(labelled)} of {len(views)} have: label all"
        )
    to_first = np.linalg.inv(poses[0]) @ poses
    parts = [view.only(view.measured) for view in views]
    if not all(len(part.points) for part in parts):
        raise InputError("each view must hold a measured point")
    points = np.concatenate([moved(part.points, pose) for part, pose in zip(parts, to_first, strict=True)])
    labels = (
        np.concatenate([part.labels for part in parts if part.labels is not None])
        if all(labelled)
        else np.zeros(len(points), np.int64)
    )
    colours = [part.colours for part in parts if part.colours is not None]
    merged = voxelised(
        LabelledCloud(points, labels, np.concatenate(colours) if len(colours) == len(parts) else None), size
    )
    cameras = [
        moved(view.camera[None], pose)[0]
        for view, pose in zip(views, to_first, strict=True)
        if view.camera is not None
    ]
    return PointCloud(
        merged.points,
        merged.labels if all(labelled) else None,
        merged.colours,
        camera=cameras[0] if cameras else None,
        from_parts=any(view.from_parts for view in views),
        source_rows=np.full(len(merged.points), -1),
        other_cameras=np.stack(cameras[1:]) if len(cameras) > 1 else None,
        frame=views[0].frame,
    )


def moved(points: NDArray[np.floating], pose: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3) float64 points after the rigid motion `pose` (4, 4)."""
    return points.astype(np.float64) @ pose[:3, :3].T + pose[:3, 3]
