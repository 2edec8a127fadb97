"""`PointCloud`: points of a sensor or a file in the sensor's frame, with optional labels and colours."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points of a sensor (thesis §2.3.2).

    Parameters
    ----------
    points : (n, 3) float32 or float64
        Metres, any frame; a point with a coordinate that is not finite was not measured.
    labels : (n,) int64, optional
        Ids as in `LabelledCloud`: 0 nothing, 1 the table, 2 and above objects. None without labels.
    colours : (n, 3) uint8, optional
        Red, green, blue.
    shape : (rows, columns), optional
        Of the organised image, row by row; None where the points have no such order.
    camera : (3,) float64, optional
        Position of the camera, in the frame of the points; finite.
    from_parts : bool
        Whether the file labelled parts of objects; `labels` are then the objects of these parts.

    Raises
    ------
    InputError
        A shape or value breaks its rule.
    """

    points: NDArray[np.floating]
    labels: NDArray[np.int64] | None = None
    colours: NDArray[np.uint8] | None = None
    shape: tuple[int, int] | None = None
    camera: NDArray[np.float64] | None = None
    from_parts: bool = False

    def __post_init__(self) -> None:
        n = len(self.points)
        if self.points.shape != (n, 3) or self.points.dtype.kind != "f":
            raise InputError(f"points must be floats of shape (n, 3), got {self.points.dtype} {self.points.shape}")
        if self.labels is not None and (self.labels.shape != (n,) or (n and self.labels.min() < 0)):
            raise InputError(f"labels must be {n} whole numbers from 0, got shape {self.labels.shape}")
        if self.colours is not None and self.colours.shape != (n, 3):
            raise InputError(f"colours must have shape ({n}, 3), got {self.colours.shape}")
        if self.shape is not None and self.shape[0] * self.shape[1] != n:
            raise InputError(f"shape {self.shape} must hold the {n} points")
        if self.camera is not None and self.camera.shape != (3,):
            raise InputError(f"camera must have shape (3,), got {self.camera.shape}")
        if self.camera is not None and not np.isfinite(self.camera).all():
            raise InputError(f"camera must be three finite numbers, got {self.camera.tolist()}; leave it out")

    @property
    def measured(self) -> NDArray[np.bool_]:
        """(n,) bool: points with three finite coordinates."""
        return finite_rows(self.points)

    @property
    def is_labelled(self) -> bool:
        """Whether any point belongs to an object or the table."""
        return self.labels is not None and bool(self.labels.any())

    def only(self, keep: NDArray) -> "PointCloud":
        """The points that `keep` ((n,) bool, or indices) names; the order of the image is lost."""
        rows = np.flatnonzero(keep) if keep.dtype == bool else keep
        return PointCloud(
            self.points.take(rows, axis=0),
            None if self.labels is None else self.labels[rows],
            None if self.colours is None else self.colours.take(rows, axis=0),
            camera=self.camera,
            from_parts=self.from_parts,
        )


def finite_rows(points: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(n,) bool: rows of (n, 3) whose numbers are all finite."""
    x, y, z = np.isfinite(points).T
    return x & y & z
