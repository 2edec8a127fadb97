"""`Sight`: what a camera saw to be empty, as opposed to what it merely did not see."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import LabelledCloud

_WIDER = 1.001
"""Width of the band of directions that is searched, in reaches; more costs time, not accuracy."""


@dataclass(frozen=True, eq=False)
class Sight:
    """Lines of sight from the camera, or from several cameras, to every point of a cloud.

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
        """Whether a camera saw through `place`, (3,) metres: something behind it on the line, nothing before it.

        Where nothing at all was measured, nothing was seen. Without a camera there is no telling: True.
        """
        if self.cloud.camera is None or not len(self.cloud.points):
            return True
        return any(self._is_free_from(number, place) for number in range(len(self._cameras)))

    def _is_free_from(self, number: int, place: NDArray[np.float64]) -> bool:
        away = place - self._cameras[number]
        distance = float(np.linalg.norm(away))
        if distance == 0:
            return True
        directions, all_depths = self._sorted[number]
        reach, towards = self.radius / distance, away / distance
        # Slightly wider than the reach, so that rounding loses no point.
        edges = towards[0] - _WIDER * reach, towards[0] + _WIDER * reach
        beside = slice(*np.searchsorted(directions[0], edges))
        apart = directions[:, beside] - towards[:, None]
        near = apart[0] ** 2 + apart[1] ** 2 + apart[2] ** 2 <= reach * reach
        depths = all_depths[beside][near]
        return bool((depths > distance + self.radius).any() and not (depths < distance - self.radius).any())

    @cached_property
    def _cameras(self) -> tuple[NDArray[np.float64], ...]:
        others = () if self.cloud.other_cameras is None else tuple(self.cloud.other_cameras)
        return () if self.cloud.camera is None else (self.cloud.camera, *others)

    @cached_property
    def _sorted(self) -> tuple[tuple[NDArray[np.float64], NDArray[np.float64]], ...]:
        """For each camera unit vectors to the points as columns, ascending in x, and the points' distances."""
        found = []
        for camera in self._cameras:
            rays = self.cloud.points - camera
            depths = np.linalg.norm(rays, axis=1)
            directions = (rays / np.maximum(depths, 1e-9)[:, None]).T
            order = np.argsort(directions[0])
            found.append((np.ascontiguousarray(directions[:, order]), depths[order]))
        return tuple(found)
