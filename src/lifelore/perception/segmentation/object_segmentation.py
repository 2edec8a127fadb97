"""Objects of a cloud without labels: the settings of a segmentation, and the labels that its method gives.

The methods have modules of their own: `convexity_segmentation`, `distance_segmentation`, `colour_segmentation`.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.segmentation.cut_confidence import CutCloud
from lifelore.perception.segmentation.plane import over_outline

METHODS = ("convexity", "clusters", "colour")


@dataclass(frozen=True)
class SegmentationSettings:
    """Settings of the segmentation of an unlabelled scene.

    Parameters
    ----------
    method : {"convexity", "clusters", "colour"}
        Surfaces that meet in creases are cut apart; Euclidean clusters; or the thesis's colour histogram (§2.3.3).
    table_band : float
        Metres; points no higher than this above the table, and no deeper below it, are the table.
    reach : float
        Height of the scene above the table, metres.
    tolerance : float
        Metres; points nearer than this are one object under ``"clusters"``.
    min_area : float
        Square metres of surface below which a cluster or region is noise.
    colours : int
        Clusters of colour under ``"colour"``; the smallest is the background.
    """

    method: Literal["convexity", "clusters", "colour"] = "convexity"
    table_band: float = 0.010
    reach: float = 0.60
    tolerance: float = 0.012
    min_area: float = 6e-4
    colours: int = 3

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise InputError(f"method must be one of {', '.join(METHODS)}, got {self.method!r}")
        for name in ("table_band", "reach", "tolerance", "min_area"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise InputError(f"{name} must be a positive number, got {getattr(self, name)}")
        if self.colours < 2:
            raise InputError(f"colours must be at least 2, got {self.colours}")


def segmented(
    points: NDArray[np.float64],
    colours: NDArray[np.uint8] | None,
    settings: SegmentationSettings,
    camera: NDArray[np.float64] | None = None,
) -> NDArray[np.int64]:
    """(n,) int64 labels of a scene in its own frame: 1 the table, 2 … objects by size, 0 the rest.

    As `cut_cloud`, without confidences.
    """
    return cut_cloud(points, colours, settings, camera).labels


def cut_cloud(
    points: NDArray[np.float64],
    colours: NDArray[np.uint8] | None,
    settings: SegmentationSettings,
    camera: NDArray[np.float64] | None = None,
) -> CutCloud:
    """Labels of a scene in its own frame: 1 the table, 2 … objects by size, 0 the rest; ``"convexity"`` is sure to
    a degree.

    `camera` (3,), where known, tells ``"convexity"`` the outer side of each surface.

    Raises
    ------
    InputError
        The colour method is asked for without colours.
    """
    labels = np.zeros(len(points), np.int64)
    labels[np.abs(points[:, 2]) <= settings.table_band] = TABLE
    above = np.flatnonzero((points[:, 2] > settings.table_band) & (points[:, 2] <= settings.reach))
    above = above[over_outline(points[above, :2], points[labels == TABLE, :2])]
    if settings.method == "colour":
        from lifelore.perception.segmentation.colour_segmentation import colour_classes

        if colours is None:
            raise InputError("method=colour needs colours, and the cloud has none; use method=convexity")
        labels[above] = colour_classes(points[above], colours[above], settings.colours)
    if settings.method == "convexity":
        from lifelore.perception.segmentation.convexity_segmentation import convex_objects

        found = convex_objects(points[above], camera, settings.min_area)
        labels[above] = found.labels
        return CutCloud(labels, found.confidence)
    if settings.method == "clusters":
        from lifelore.perception.segmentation.distance_segmentation import euclidean_clusters

        labels[above] = euclidean_clusters(points[above], settings.tolerance, settings.min_area)
    return CutCloud(labels)
