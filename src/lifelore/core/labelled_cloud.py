"""`LabelledCloud`: points with the object that each belongs to, in the scene frame."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.cloud_origin import SCENE_ITSELF, CloudOrigin
from lifelore.core.errors import InputError

UNLABELLED = 0
TABLE = 1
"""The table's label; objects are 2 and above."""


@dataclass(frozen=True, eq=False)
class LabelledCloud:
    """A scene as points with labels (thesis §2.3.2).

    Parameters
    ----------
    points : (n, 3) float
        Metres, finite, z up; z = 0 at the table where one is known. Stored as float64.
    labels : (n,) int
        Stored as int64, not changed afterwards. `UNLABELLED` (0), `TABLE` (1), or the number of an object (2 and
        above).
    colours : (n, 3) uint8, optional
    camera : (3,) float64, optional
        Position of the camera, in the same frame.
    other_cameras : (k, 3) float64, optional
        Positions of further cameras, of a cloud that several views make.
    origin : CloudOrigin
        The way back to the cloud that was read: pose, pixels, name of the frame.

    Raises
    ------
    InputError
        A shape or value breaks its rule.

    Examples
    --------
    >>> cloud = LabelledCloud(np.zeros((3, 3)), np.array([1, 2, 2]))
    >>> cloud.of(2).shape
    (2, 3)
    """

    points: NDArray[np.float64]
    labels: NDArray[np.int64]
    colours: NDArray[np.uint8] | None = None
    camera: NDArray[np.float64] | None = None
    other_cameras: NDArray[np.float64] | None = None
    origin: CloudOrigin = SCENE_ITSELF

    def __post_init__(self) -> None:
        n = len(self.points)
        if self.points.shape != (n, 3) or not np.isfinite(self.points).all():
            raise InputError(f"points must be finite and of shape (n, 3), got shape {self.points.shape}")
        if self.labels.shape != (n,) or self.labels.dtype.kind not in "iu" or (n and self.labels.min() < 0):
            raise InputError(
                f"labels must be {n} whole numbers from 0, got shape {self.labels.shape} of {self.labels.dtype}"
            )
        # Compiled functions take these kinds of numbers alone.
        object.__setattr__(self, "points", self.points.astype(np.float64, copy=False))
        object.__setattr__(self, "labels", self.labels.astype(np.int64, copy=False))
        if self.colours is not None and self.colours.shape != (n, 3):
            raise InputError(f"colours must have shape ({n}, 3), got {self.colours.shape}")
        if self.camera is not None and self.camera.shape != (3,):
            raise InputError(f"camera must have shape (3,), got {self.camera.shape}")
        others = self.other_cameras
        if others is not None and (self.camera is None or others.ndim != 2 or others.shape[1] != 3):
            raise InputError(f"other_cameras must have shape (k, 3) and stand beside a camera, got {others.shape}")
        rows = self.origin.rows
        if rows is not None and rows.shape != (n,):
            raise InputError(f"origin.rows must have shape ({n},), got {rows.shape}")

    @property
    def objects(self) -> tuple[int, ...]:
        """Numbers of the objects that have points, ascending; the table is not among them."""
        return tuple(label for label in self._rows if label > TABLE)

    @property
    def has_table(self) -> bool:
        """Whether any point belongs to the table."""
        return bool((self.labels == TABLE).any())

    def of(self, label: int) -> NDArray[np.float64]:
        """The points of one object, shape ``(m, 3)``."""
        return self.points[self.rows_of(label)]

    def rows_of(self, label: int) -> NDArray[np.int64]:
        """Rows of the points of one object, ascending, shape ``(m,)``."""
        return self._rows.get(label, np.empty(0, np.int64))

    @cached_property
    def _rows(self) -> dict[int, NDArray[np.int64]]:
        """The points of each label, ascending, in the order of the cloud."""
        # Short integers are sorted by radix.
        short = self.labels.astype(np.uint16) if len(self.labels) and self.labels.max() < 1 << 16 else self.labels
        order = np.argsort(short, kind="stable")
        found, first = np.unique(short[order], return_index=True)
        return dict(zip(found.tolist(), np.split(order, first[1:]), strict=True)) if len(found) else {}
