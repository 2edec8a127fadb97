"""`PointCloud`: points of a sensor or a file in the sensor's frame, with optional labels and colours."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lifelore.core.cloud_origin import NO_FRAME, SensorFrame
from lifelore.core.errors import InputError
from lifelore.perception.clouds.camera_intrinsics import CameraIntrinsics
from lifelore.perception.clouds.depth_image import metres_of_depth


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
    grid : (height, width), optional
        Pixels of the sensor's image, if the cloud is organised; None if the points belong to no image.
    camera : (3,) float64, optional
        Position of the camera, in the frame of the points; finite.
    from_parts : bool
        Whether the file labelled parts of objects; `labels` are then the objects of these parts.
    source_rows : (n,) int64, optional
        Row of each point in the cloud that was read, -1 for a mean of several points; with a `grid` the number
        of its pixel, row by row from 0. None if the points are all of that cloud, in its order. `only` keeps
        them, so that a part of an organised cloud still knows its neighbours in the image.
    other_cameras : (k, 3) float64, optional
        Positions of further cameras, of a cloud that several views make.
    frame : SensorFrame
        Name and time of the frame of the points, where the source names them.

    Raises
    ------
    InputError
        A shape or value breaks its rule.

    Examples
    --------
    >>> camera = CameraIntrinsics(4, 3, 5.0, 5.0, 1.5, 1.0)
    >>> PointCloud.from_depth(np.full((3, 4), 0.8), camera).points.shape
    (12, 3)
    """

    points: NDArray[np.floating]
    labels: NDArray[np.int64] | None = None
    colours: NDArray[np.uint8] | None = None
    grid: tuple[int, int] | None = None
    camera: NDArray[np.float64] | None = None
    from_parts: bool = False
    source_rows: NDArray[np.int64] | None = None
    other_cameras: NDArray[np.float64] | None = None
    frame: SensorFrame = NO_FRAME

    def __post_init__(self) -> None:
        n = len(self.points)
        if self.points.shape != (n, 3) or self.points.dtype.kind != "f":
            raise InputError(f"points must be floats of shape (n, 3), got {self.points.dtype} {self.points.shape}")
        if self.labels is not None and (self.labels.shape != (n,) or (n and self.labels.min() < 0)):
            raise InputError(f"labels must be {n} whole numbers from 0, got shape {self.labels.shape}")
        if self.colours is not None and self.colours.shape != (n, 3):
            raise InputError(f"colours must have shape ({n}, 3), got {self.colours.shape}")
        self._check_grid()
        if self.camera is not None and self.camera.shape != (3,):
            raise InputError(f"camera must have shape (3,), got {self.camera.shape}")
        others = self.other_cameras
        if others is not None and (self.camera is None or others.ndim != 2 or others.shape[1] != 3):
            raise InputError(f"other_cameras must have shape (k, 3) and stand beside a camera, got {others.shape}")
        if self.camera is not None and not np.isfinite(self.camera).all():
            raise InputError(f"camera must be three finite numbers, got {self.camera.tolist()}; leave it out")

    @classmethod
    def from_depth(
        cls,
        depth: NDArray,
        intrinsics: CameraIntrinsics,
        colours: NDArray[np.uint8] | None = None,
        *,
        depth_scale: float | None = None,
    ) -> "PointCloud":
        """The organised cloud of a depth image, in the camera's frame: x right, y down, z forward.

        Parameters
        ----------
        depth : (height, width) numbers
            Depth along the optical axis; zero, negative and NaN mean that nothing was measured.
        intrinsics : CameraIntrinsics
            Of an image of this size.
        colours : (height, width, 3) uint8, optional
            Aligned with the depth.
        depth_scale : float, optional
            Metres for each unit of depth. Default: 0.001 for integers, 1 for floats.

        Returns
        -------
        PointCloud
            One point for each pixel, row by row, NaN where nothing was measured; `grid` is (height, width) and
            `camera` the origin.

        Raises
        ------
        InputError
            Shapes differ, a type or the scale breaks its rule, or nothing was measured.

        Examples
        --------
        >>> camera = CameraIntrinsics(2, 1, fx=64.0, fy=64.0, cx=0.0, cy=0.0)
        >>> PointCloud.from_depth(np.array([[0.5, 1.0]]), camera).points.tolist()
        [[0.0, 0.0, 0.5], [0.015625, 0.0, 1.0]]
        """
        z = metres_of_depth(depth, depth_scale)
        if z.shape != intrinsics.grid:
            raise InputError(
                f"the depth image has {z.shape[1]} × {z.shape[0]} pixels, but the intrinsics are of"
                f" {intrinsics.width} × {intrinsics.height}: give the intrinsics of this image"
            )
        if colours is not None and colours.shape[:2] != z.shape:
            raise InputError(
                f"the colour image has {colours.shape[1]} × {colours.shape[0]} pixels, the depth image"
                f" {z.shape[1]} × {z.shape[0]}: give a colour image aligned with the depth"
            )
        rays = intrinsics.rays().astype(z.dtype)
        points = np.stack([rays[..., 0] * z, rays[..., 1] * z, z], axis=-1).reshape(-1, 3)
        flat = None if colours is None else np.ascontiguousarray(colours.reshape(-1, 3))
        frame = SensorFrame(intrinsics.frame)
        return cls(points, None, flat, intrinsics.grid, np.zeros(3), frame=frame)

    def _check_grid(self) -> None:
        n, rows = len(self.points), self.source_rows
        if rows is not None and rows.shape != (n,):
            raise InputError(f"source_rows must be {n} numbers, got shape {rows.shape}")
        if self.grid is None:
            return
        pixels = self.grid[0] * self.grid[1]
        if rows is None and pixels != n:
            raise InputError(f"grid {self.grid} must hold the {n} points; give source_rows for a part of it")
        if rows is not None and n and not 0 <= rows.min() <= rows.max() < pixels:
            raise InputError(f"source_rows must lie in 0 to {pixels - 1} for grid {self.grid}")

    @property
    def pixels(self) -> NDArray[np.int64]:
        """(n, 2) int64: row and column of each point in the grid.

        Raises
        ------
        InputError
            The cloud is not organised.
        """
        if self.grid is None:
            raise InputError(
                "pixels need an organised cloud (grid of height and width), but this cloud has no grid"
            )
        numbers = np.arange(len(self.points)) if self.source_rows is None else self.source_rows
        return np.stack(np.divmod(numbers, self.grid[1]), axis=1)

    @property
    def measured(self) -> NDArray[np.bool_]:
        """(n,) bool: points with three finite coordinates."""
        return finite_rows(self.points)

    @property
    def is_labelled(self) -> bool:
        """Whether any point belongs to an object or the table."""
        return self.labels is not None and bool(self.labels.any())

    def only(self, keep: NDArray) -> "PointCloud":
        """The points that `keep` ((n,) bool, or indices) names; they keep their rows in the source."""
        rows = np.flatnonzero(keep) if keep.dtype == bool else keep
        return replace(
            self,
            points=self.points.take(rows, axis=0),
            labels=None if self.labels is None else self.labels[rows],
            colours=None if self.colours is None else self.colours.take(rows, axis=0),
            source_rows=rows.astype(np.int64) if self.source_rows is None else self.source_rows[rows],
        )


def finite_rows(points: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(n,) bool: rows of (n, 3) whose numbers are all finite."""
    x, y, z = np.isfinite(points).T
    return x & y & z
