"""`Sight`: what the camera saw to be empty, as opposed to what it merely did not see."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import LabelledCloud


@dataclass(frozen=True, eq=False)
class Sight:
    """Lines of sight from the camera to every point of a cloud.

    Parameters
    ----------
    cloud : LabelledCloud
        With or without a camera.
    radius : float
        How near to a line of sight a point must be to lie on it, metres; above the spacing of the points.
    """

    cloud: LabelledCloud
    radius: float

    def is_free(self, place: NDArray[np.float64]) -> bool:
        """Whether the camera saw through `place`, (3,) metres: something behind it on the line, nothing before it.

        Where nothing at all was measured, nothing was seen. Without a camera there is no telling: True.
        """
        if self.cloud.camera is None or not len(self.cloud.points):
            return True
        away = place - self.cloud.camera
        distance = float(np.linalg.norm(away))
        if distance == 0:
            return True
        reach = self.radius / distance
        beside = self._directions - (away / distance)[:, None]
        near = beside[0] ** 2 + beside[1] ** 2 + beside[2] ** 2 <= reach * reach
        depths = self._depths[near]
        return bool((depths > distance + self.radius).any() and not (depths < distance - self.radius).any())

    @cached_property
    def _rays(self) -> NDArray[np.float64]:
        return self.cloud.points - np.asarray(self.cloud.camera)

    @cached_property
    def _depths(self) -> NDArray[np.float64]:
        return np.linalg.norm(self._rays, axis=1)

    @cached_property
    def _directions(self) -> NDArray[np.float64]:
        """Unit vectors from the camera, one a column."""
        return np.ascontiguousarray((self._rays / np.maximum(self._depths, 1e-9)[:, None]).T)
