"""`GraspedTabletop`: whether a parallel gripper reaches a grasp among settled objects, and whether it holds.

A grasp is reached if fingers and palm, open and on their way in, touch nothing. It holds by force closure: both
fingertips first meet the object, and the line between the two contacts lies within both friction cones (soft
fingertips; Nguyen 1988). The object's weight and the fingers' force are not simulated.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import Shape

OPENING = 0.14
"""Metres between the open fingers; that of a common large gripper."""
FRICTION = 0.7
"""Coefficient between fingertips and objects; that of objects in the simulator."""
THICK, BROAD, LONG, TIP = 0.008, 0.02, 0.06, 0.01
"""Of a finger, metres; the pads' middle is `TIP` from its end."""
WAY_IN = (0.0, 0.02, 0.05, 0.1)
"""Metres before the grasp at which collisions are looked for."""
_PARTS = ("finger0", "finger1", "palm")
_HALF = {
    "finger0": (THICK / 2, BROAD / 2, LONG / 2),
    "finger1": (THICK / 2, BROAD / 2, LONG / 2),
    "palm": (OPENING / 2 + THICK, BROAD, 0.02),
}


@dataclass(frozen=True, eq=False)
class Grasp:
    """A pose of the gripper: `position` (3,) between the pads, metres; `approach` and `closing` (3,) unit vectors
    at right angles, along which the hand comes and the fingers close."""

    position: NDArray[np.float64]
    approach: NDArray[np.float64]
    closing: NDArray[np.float64]


class GraspedTabletop(Tabletop):
    """Settled objects and a gripper that is put among them; nothing moves.

    Parameters
    ----------
    shapes : sequence of Shape
    poses : sequence of Pose
    """

    def __init__(self, shapes: Sequence[Shape], poses: Sequence[Pose]) -> None:
        super().__init__(shapes, poses, _gripper_xml())
        self._tools = [self._model.geom(name).id for name in _PARTS]
        self._objects = np.flatnonzero(self._shape_of_geom >= 0)

    def is_reached(self, grasp: Grasp) -> bool:
        """Whether the open gripper comes to a grasp without touching an object or the table."""
        return all(self._is_free(grasp, before) for before in WAY_IN)

    def holds(self, grasp: Grasp, number: int) -> bool:
        """Whether the fingers, once closed, hold an object by force closure."""
        rays = np.array([-grasp.closing, grasp.closing])
        contacts, inward = [], []
        for ray in rays:
            shape, along, normal = self.cast(grasp.position - ray * OPENING / 2, ray[None])
            if shape[0] != number or along[0] > OPENING:
                return False
            contacts.append(grasp.position - ray * OPENING / 2 + along[0] * ray)
            inward.append(-normal[0])
        line = contacts[1] - contacts[0]
        length = float(np.linalg.norm(line))
        least = np.cos(np.arctan(FRICTION))
        return length > 1e-4 and inward[0] @ line / length >= least and -inward[1] @ line / length >= least

    def succeeds(self, grasp: Grasp, number: int) -> bool:
        """Whether the gripper reaches a grasp of an object, and the grasp holds."""
        return self.holds(grasp, number) and self.is_reached(grasp)

    def _is_free(self, grasp: Grasp, before: float) -> bool:
        rotation = np.stack([grasp.closing, np.cross(grasp.approach, grasp.closing), grasp.approach], axis=1)
        middle = grasp.position - before * grasp.approach
        aside, back = (OPENING + THICK) / 2, LONG / 2 - TIP
        places = {
            "finger0": middle + aside * grasp.closing - back * grasp.approach,
            "finger1": middle - aside * grasp.closing - back * grasp.approach,
            "palm": middle - (LONG - TIP + _HALF["palm"][2]) * grasp.approach,
        }
        segment = np.zeros(6)
        for name, tool in zip(_PARTS, self._tools, strict=True):
            if places[name][2] - np.abs(rotation[2]) @ np.array(_HALF[name]) < 0:
                return False
            self._data.geom_xpos[tool], self._data.geom_xmat[tool] = places[name], rotation.ravel()
            reach = self._model.geom_rbound[tool] + self._model.geom_rbound[self._objects]
            near = np.linalg.norm(self._data.geom_xpos[self._objects] - places[name], axis=1) <= reach
            for part in self._objects[near]:
                if self._mujoco.mj_geomDistance(self._model, self._data, tool, int(part), 0.01, segment) <= 0:
                    return False
        return True


def _gripper_xml() -> str:
    """Three boxes without contacts, far away; they are placed for distances only."""
    boxes = "".join(
        f'<geom name="{name}" type="box" size="{" ".join(map(str, _HALF[name]))}" group="2" contype="0" '
        'conaffinity="0"/>'
        for name in _PARTS
    )
    return f'<worldbody><body mocap="true" pos="0 0 50">{boxes}</body></worldbody>'
