"""MuJoCo's part of the tabletop job: two kinematic fingers and a grip of limited force among settled objects.

The fingers are mocap capsules that collide with all objects but the gripped one. The grip is a weld between the
gripped object and the hand, which is released where its force exceeds the gripper's limit for `SLIP_TIME` seconds.
Other objects move by contact alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import Shape
from lifelore.domains.tabletop_job.job_types import Gripper

CLEARANCE = 0.004
"""Metres between an object and each finger when the fingers descend."""
FINGER_LENGTH = 0.3
"""Metres."""
SLIP_TIME = 0.03
"""Seconds for which the force must exceed the limit until the grip is lost."""
PRESS = 40.0
"""Newtons of upward force on a descending finger at which it stops; below, it pushes objects aside."""
EDGE = 0.75
"""Metres from the tray's middle to the table's edge; an object beyond it is lost."""
STEP = 0.004
"""Seconds; twice the step of `Tabletop`, whose objects have already settled. Less costs time."""
CHECK = 3
"""Steps between two checks of forces."""
_AWAY = (0.0, 0.0, 50.0)
_GRAVITY = 9.81


@dataclass(frozen=True, eq=False)
class Grip:
    """The held object, and the fingers: offsets ``(2, 3)`` and rotation ``(3, 3)`` in the hand's frame."""

    object: int
    offsets: NDArray[np.float64]
    rotation: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TrayState:
    """All that a `GripperTray` needs to go on from here, bit for bit; it can be pickled."""

    physics: NDArray[np.float64]
    grip: Grip | None
    gone: frozenset[int]


class GripperTray(Tabletop):
    """Objects on a table and a gripper.

    Parameters
    ----------
    shapes : sequence of Shape
        The objects.
    poses : sequence of Pose
    gripper : Gripper

    Attributes
    ----------
    gripper : Gripper
    grip : Grip or None
        What is held.
    gone : frozenset of int
        Objects that were handed over or lost.
    """

    def __init__(self, shapes: Sequence[Shape], poses: Sequence[Pose], gripper: Gripper) -> None:
        super().__init__(shapes, poses, _tools_xml(gripper))
        model = self._model
        model.opt.timestep = STEP
        self._everything = int(self._mujoco.mjtState.mjSTATE_INTEGRATION)
        self.gripper = gripper
        self.grip: Grip | None = None
        self.gone: frozenset[int] = frozenset()
        self._roots = np.array(self._root)
        self._masses = self.weights / _GRAVITY
        self._limits = self._speed_limits(0.004)
        self._shape_of_dof = np.array([self._owner(body) for body in model.dof_bodyid])
        self._shape_of_body = np.array([self._owner(body) for body in range(model.nbody)])
        self._hand, *self._fingers = (model.body(name).mocapid[0] for name in ("hand", "finger0", "finger1"))
        self._finger_geoms = [model.geom(name).id for name in ("finger0", "finger1")]
        self._pointer = model.geom("pointer").id
        self._set_masks()
        self.highest = self.centres[:, 2].copy()

    def _owner(self, body: int) -> int:
        found = np.flatnonzero(self._roots == self._model.body_rootid[body])
        return int(found[0]) if len(found) else -1

    # --- what is where ----------------------------------------------------------------------------------------

    @property
    def n_objects(self) -> int:
        """Objects at the start."""
        return len(self._shapes)

    @property
    def here(self) -> list[int]:
        """Objects on the table or in the hand, ascending."""
        return [k for k in range(self.n_objects) if k not in self.gone]

    @property
    def centres(self) -> NDArray[np.float64]:
        """Middle ``(n, 3)`` of every object's frame, metres; a copy."""
        return self._data.xpos[self._roots].copy()

    @property
    def time(self) -> float:
        """Simulated seconds."""
        return float(self._data.time)

    def outline(self, number: int) -> NDArray[np.float64]:
        """Points ``(m, 3)`` that span an object where it is now."""
        return self._pose(number).apply(self._bent(number, self._shapes[number]).outline())

    def distance_to(self, number: int, point: NDArray[np.float64]) -> float:
        """Metres from a point to an object's surface, at most 2; negative within."""
        self._data.geom_xpos[self._pointer] = point
        parts = np.flatnonzero(self._shape_of_geom == number)
        segment = np.zeros(6)
        return min(
            self._mujoco.mj_geomDistance(self._model, self._data, self._pointer, int(part), 2.0, segment)
            for part in parts
        )

    def hand(self) -> Pose:
        """Where the hand is."""
        rotation = np.zeros(9)
        self._mujoco.mju_quat2Mat(rotation, self._data.mocap_quat[self._hand])
        return Pose(self._data.mocap_pos[self._hand].copy(), rotation.reshape(3, 3))

    # --- copies -----------------------------------------------------------------------------------------------

    def state(self) -> TrayState:
        """A copy of the present state."""
        physics = np.empty(self._mujoco.mj_stateSize(self._model, self._everything))
        self._mujoco.mj_getState(self._model, self._data, physics, self._everything)
        return TrayState(physics, self.grip, self.gone)

    def restore(self, state: TrayState) -> None:
        """Go back to a state of this tray or of a tray made from the same shapes, poses and gripper."""
        self.grip, self.gone = state.grip, state.gone
        self._mujoco.mj_setState(self._model, self._data, state.physics, self._everything)
        self._set_masks()
        if self.grip is not None:
            self._bind(self.grip.object)
        self._derive()
        self.highest = self.centres[:, 2].copy()

    def _derive(self) -> None:
        """Compute places and contacts from the present state alone, as after `restore`."""
        physics = self.state().physics
        self._mujoco.mj_forward(self._model, self._data)
        # The solver's start is part of the state, and mj_forward has just moved it.
        self._mujoco.mj_setState(self._model, self._data, physics, self._everything)

    # --- time -------------------------------------------------------------------------------------------------

    def step(self, steps: int = 1) -> None:
        """Let `steps` times `STEP` pass, and note how high every object has been."""
        self._mujoco.mj_step(self._model, self._data, steps)
        np.maximum(self.highest, self._data.xpos[self._roots, 2], out=self.highest)

    def rest(self, longest: float = 2.0) -> None:
        """Let time pass until all objects but the held are still, at most `longest` seconds."""
        held = -1 if self.grip is None else self.grip.object
        watched = ~np.isin(self._shape_of_dof, [held, -1, *self.gone])
        calm = 0
        for _ in range(int(longest / (12 * STEP))):
            self.step(12)
            calm = calm + 1 if (np.abs(self._data.qvel[watched]) < self._limits[watched]).all() else 0
            if calm == 2:
                break
        self._derive()

    # --- hand and fingers -------------------------------------------------------------------------------------

    def place_fingers(self, centres: NDArray[np.float64], rotation: NDArray[np.float64]) -> None:
        """Put the fingers' middles at `centres` ``(2, 3)``."""
        quaternion = self._quaternion(rotation)
        for finger, centre in zip(self._fingers, centres, strict=True):
            self._data.mocap_pos[finger] = centre
            self._data.mocap_quat[finger] = quaternion

    def withdraw(self) -> None:
        """Take the fingers away from the table."""
        self.place_fingers(np.array([_AWAY, _AWAY]), np.eye(3))

    def spare(self, number: int | None) -> None:
        """Let the fingers pass through an object (the object they reach around), and through no other."""
        self._set_masks(number)

    def blocked(self) -> bool:
        """Whether a finger is pressed upwards by more than `PRESS` newtons."""
        geoms = np.array(self._data.contact.geom).reshape(-1, 2)
        force, wrench = 0.0, np.zeros(6)
        for contact in np.flatnonzero(np.isin(geoms, self._finger_geoms).any(axis=1)):
            self._mujoco.mj_contactForce(self._model, self._data, contact, wrench)
            frame = np.array(self._data.contact[contact].frame).reshape(3, 3)
            upward = float((wrench[:3] @ frame)[2])
            force += upward if geoms[contact, 1] in self._finger_geoms else -upward
        return force > PRESS

    def grasp(self, number: int, centres: NDArray[np.float64], rotation: NDArray[np.float64]) -> None:
        """Hold an object where it is, the fingers' middles at `centres` ``(2, 3)``."""
        pose = self._pose(number)
        offsets = (centres - pose.position) @ pose.rotation
        self.grip = Grip(number, offsets, pose.rotation.T @ rotation)
        self._set_masks()
        self._bind(number)
        self._data.eq_active[0] = 1
        self.move_hand(pose)

    def release(self) -> None:
        """Let go of what is held."""
        self.grip = None
        self._data.eq_active[0] = 0
        self._set_masks()

    def move_hand(self, pose: Pose) -> None:
        """Put the hand, and the fingers with it, at a pose; the held object follows as time passes."""
        self._data.mocap_pos[self._hand] = pose.position
        self._data.mocap_quat[self._hand] = self._quaternion(pose.rotation)
        if self.grip is not None:
            self.place_fingers(pose.apply(self.grip.offsets), pose.rotation @ self.grip.rotation)

    def follow(self, path: Callable[[float], Pose], seconds: float) -> bool:
        """Move the hand along ``path(t)``, 0 ≤ t ≤ `seconds`; False where too much force ends the grip."""
        assert self.grip is not None
        weight = self._masses[self.grip.object] * _GRAVITY
        limit = min(self.gripper.strength, self.gripper.grip * weight)
        too_much = 0
        for k in range(1, round(seconds / STEP) + 1):
            self.move_hand(path(min(k * STEP, seconds)))
            self.step()
            if k % CHECK == 0:
                too_much = too_much + 1 if self.grip_force() > limit else 0
                if too_much * CHECK * STEP >= SLIP_TIME:
                    self.release()
                    return False
        return True

    def grip_force(self) -> float:
        """Newtons between hand and held object."""
        # The weld is the only equality, and equalities are the first rows: three of force, three of torque.
        return float(np.linalg.norm(self._data.efc_force[:3])) if self._data.ne else 0.0

    def push(self, number: int, force: NDArray[np.float64]) -> None:
        """Act on an object's middle with a force ``(3,)`` in newtons until the next call."""
        self._data.xfrc_applied[self._roots[number], :3] = force

    def velocity(self, number: int) -> NDArray[np.float64]:
        """Linear velocity ``(3,)`` of an object, m/s."""
        start = self._model.body_dofadr[self._roots[number]]
        return self._data.qvel[start : start + 3].copy()

    def remove(self, number: int) -> None:
        """Take an object off the table for good."""
        if self.grip is not None and self.grip.object == number:
            self.release()
        self.gone = self.gone | {number}
        root = self._roots[number]
        start = self._model.jnt_qposadr[self._model.body_jntadr[root]]
        self._data.qpos[start : start + 3] = (0.0, 100.0 + 2 * number, 10.0)
        self._data.qvel[self._shape_of_dof == number] = 0.0
        # Nothing touches it any more, and a force bears its weight.
        self._data.xfrc_applied[root] = (0.0, 0.0, self._masses[number] * _GRAVITY, 0.0, 0.0, 0.0)
        self._set_masks()
        self._mujoco.mj_forward(self._model, self._data)

    def _quaternion(self, rotation: NDArray[np.float64]) -> NDArray[np.float64]:
        quaternion = np.zeros(4)
        self._mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation).ravel())
        return quaternion

    def _bind(self, number: int) -> None:
        self._model.eq_obj2id[0] = self._roots[number]
        self._model.eq_data[0] = 0.0
        self._model.eq_data[0, 6] = self._model.eq_data[0, 10] = 1.0

    def _set_masks(self, spared: int | None = None) -> None:
        """Bit 1 of affinity: other objects; bit 2: fingers."""
        if self.grip is not None:
            spared = self.grip.object
        model, objects = self._model, self._shape_of_geom
        affinity = np.where(objects == spared, 1, 3)
        gone = np.isin(objects, list(self.gone))
        mine = objects >= 0
        model.geom_conaffinity[mine] = np.where(gone, 0, affinity)[mine]
        model.geom_contype[mine] = np.where(gone, 0, 1)[mine]
        bodies = self._shape_of_body
        mine, gone = bodies >= 0, np.isin(bodies, list(self.gone))
        model.body_conaffinity[mine] = np.where(gone, 0, np.where(bodies == spared, 1, 3))[mine]
        model.body_contype[mine] = np.where(gone, 0, 1)[mine]


def _tools_xml(gripper: Gripper) -> str:
    """The hand, the fingers, a pointer that touches nothing, and the grip."""
    away = " ".join(map(str, _AWAY))
    # A capsule's length is that of its straight part.
    size = f"{gripper.thickness / 2:.9g} {(FINGER_LENGTH - gripper.thickness) / 2:.9g}"
    fingers = "".join(
        f'<body name="finger{k}" mocap="true" pos="{away}"><geom name="finger{k}" type="capsule" size="{size}" '
        'group="2" contype="2" conaffinity="0"/></body>'
        for k in range(2)
    )
    return (
        f'<worldbody><body name="hand" mocap="true" pos="{away}"/>{fingers}<body mocap="true" pos="{away}">'
        '<geom name="pointer" type="sphere" size="0.0001" group="2" contype="0" conaffinity="0"/></body>'
        "</worldbody>"
        '<equality><weld body1="hand" body2="thing0" active="false" solref="0.02 1" solimp="0.95 0.99 0.001"/>'
        "</equality>"
    )
