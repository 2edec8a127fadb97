"""`Sight`: what the camera saw to be empty, as opposed to what it merely did not see."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import LabelledCloud

_WIDER = 1.001
"""Width of the band of directions that is searched, in reaches; more costs time, not accuracy."""


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
        reach, towards = self.radius / distance, away / distance
        # Slightly wider than the reach, so that rounding loses no point.
        edges = towards[0] - _WIDER * reach, towards[0] + _WIDER * reach
        beside = slice(*np.searchsorted(self._directions[0], edges))
        apart = self._directions[:, beside] - towards[:, None]
        near = apart[0] ** 2 + apart[1] ** 2 + apart[2] ** 2 <= reach * reach
        depths = self._depths[beside][near]
        return bool((depths > distance + self.radius).any() and not (depths < distance - self.radius).any())

    @cached_property
    def _rays(self) -> NDArray[np.float64]:
        return self.cloud.points - np.asarray(self.cloud.camera)

    @cached_property
    def _sorted(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Unit vectors from the camera, one a column, ascending in x; and the distances of their points."""
        depths = np.linalg.norm(self._rays, axis=1)
        directions = (self._rays / np.maximum(depths, 1e-9)[:, None]).T
        order = np.argsort(directions[0])
        return np.ascontiguousarray(directions[:, order]), depths[order]

    @property
    def _directions(self) -> NDArray[np.float64]:
        return self._sorted[0]

    @property
    def _depths(self) -> NDArray[np.float64]:
        return self._sorted[1]
