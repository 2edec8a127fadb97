"""`PokedTabletop`: a settled tabletop whose objects a fingertip pushes, and pictures of it from a fixed camera."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.photograph import photograph
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import Shape

FINGERTIP = 0.008
"""Radius of the fingertip, metres."""
BACKWARD = 0.02
"""Metres before the surface at which the fingertip starts."""
SPEED = 0.05
"""Of the fingertip, m/s."""
REST = 2.0
"""Longest time after a poke until the picture, seconds."""
_TIME_STEP = 0.002
_AWAY = np.array([0.0, 0.0, 50.0])
_TOOL = (
    '<worldbody><body name="fingertip" mocap="true" pos="0 0 50">'
    f'<geom name="fingertip" type="sphere" size="{FINGERTIP}" group="2"/></body></worldbody>'
)


class PokedTabletop(Tabletop):
    """Solid objects on a table and a fingertip that moves along a straight line; the finger behind it is left out.

    Parameters
    ----------
    shapes : sequence of Shape
        Solid shapes; no cloths.
    poses : sequence of Pose
        Where they rest.
    """

    def __init__(self, shapes: Sequence[Shape], poses: Sequence[Pose]) -> None:
        super().__init__(shapes, poses, _TOOL)
        self._tip = self._model.geom("fingertip").id
        self._withdraw()

    def poke(self, place: NDArray[np.float64], push: NDArray[np.float64]) -> bool:
        """Move the fingertip towards a surface point and then by `push`; objects come to rest afterwards.

        Parameters
        ----------
        place, push : (3,) float64
            Metres; the fingertip starts `BACKWARD` metres before `place`.

        Returns
        -------
        bool
            False if the fingertip has no room to start; then nothing moves.
        """
        length = float(np.linalg.norm(push))
        way = push / length
        start = place - (BACKWARD + FINGERTIP) * way
        self._data.mocap_pos[0] = start
        self._mujoco.mj_kinematics(self._model, self._data)
        if start[2] < FINGERTIP or self._room() <= 0:
            self._withdraw()
            return False
        steps = round((BACKWARD + length) / SPEED / _TIME_STEP)
        for step in range(1, steps + 1):
            self._data.mocap_pos[0] = start + way * SPEED * _TIME_STEP * step
            self._mujoco.mj_step(self._model, self._data)
        self._withdraw()
        self.settle(longest=float(self._data.time) + REST)
        self._mujoco.mj_forward(self._model, self._data)
        return True

    def picture(self, view: Pose, camera: str, rng: np.random.Generator) -> LabelledCloud:
        """The cloud that a camera of `depth_camera.CAMERAS` sees from `view` now; hidden objects are allowed."""
        outlines = [pose.apply(shape.outline()) for shape, pose in zip(self.shapes, self.poses, strict=True)]
        photo = photograph(self, outlines, view, CAMERAS[camera], rng, fewest=0)
        assert photo is not None
        return photo.cloud

    def _room(self) -> float:
        """Metres from the fingertip to the nearest object, at most 0.1."""
        segment = np.zeros(6)
        parts = np.flatnonzero(self._shape_of_geom >= 0)
        return min(
            self._mujoco.mj_geomDistance(self._model, self._data, self._tip, int(part), 0.1, segment)
            for part in parts
        )

    def _withdraw(self) -> None:
        self._data.mocap_pos[0] = _AWAY
        self._mujoco.mj_forward(self._model, self._data)
