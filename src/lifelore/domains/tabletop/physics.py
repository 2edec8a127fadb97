"""MuJoCo's part of the tabletop: settle placed shapes, read contacts, cast rays. No other file knows MuJoCo.

Since MuJoCo 3.9 a contact is detected where dist < margin + gap and pushes where dist < margin: with margin 0 and
a gap of `NEAR` objects rest on, not above, one another and near misses are still reported.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import MissingExtraError
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.shapes import Shape, ShapePart

NEAR = 0.004
"""Metres within which surfaces count as touching."""
_TYPES = {"box": "box", "cylinder": "cylinder", "ball": "sphere", "ellipsoid": "ellipsoid", "capsule": "capsule"}
_CHUNK = 25
_RAYS_GROUPS = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)

_OPTIONS = (
    '<option timestep="0.002" cone="elliptic" impratio="5"/>'
    f'<default><geom condim="6" friction="0.7 0.003 0.001" margin="0" gap="{NEAR}" solref="0.01 1"/></default>'
)


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts and near misses of a settled scene; bodies are numbers of shapes, −1 the table.

    `normals` ``(k, 3)`` point from the first body to the second; `forces` ``(k, 3)`` act on the second, newtons;
    `distances` ``(k,)`` in metres, negative where surfaces overlap.
    """

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    normals: NDArray[np.float64]
    forces: NDArray[np.float64]
    distances: NDArray[np.float64]
    positions: NDArray[np.float64]


class Tabletop:
    """Shapes on a table, stepped by MuJoCo.

    Parameters
    ----------
    shapes : sequence of Shape
    poses : sequence of Pose
        Where each shape's frame is at the start.
    tools : str
        MJCF sections of bodies that are no objects, e.g. a gripper, and their constraints.

    Raises
    ------
    MissingExtraError
        MuJoCo is not installed.
    """

    def __init__(self, shapes: Sequence[Shape], poses: Sequence[Pose], tools: str = "") -> None:
        self._mujoco = _mujoco()
        self._shapes = tuple(shapes)
        self._model: Any = self._mujoco.MjModel.from_xml_string(_scene_xml(shapes, poses, tools))
        self._data: Any = self._mujoco.MjData(self._model)
        self._root = [self._model.body(f"thing{number}").id for number in range(len(self._shapes))]
        # The table is geom 0 on the world body; every other geom belongs to the shape whose free body carries it.
        shape_of_root = np.full(self._model.nbody, -1)
        shape_of_root[self._root] = range(len(self._root))
        self._shape_of_geom = shape_of_root[self._model.body_rootid[self._model.geom_bodyid]]
        self._mujoco.mj_forward(self._model, self._data)

    @property
    def weights(self) -> NDArray[np.float64]:
        """Newtons, one a shape."""
        return self._model.body_subtreemass[self._root] * 9.81

    @property
    def poses(self) -> tuple[Pose, ...]:
        """Where the shapes are now."""
        return tuple(self._pose(number) for number in range(len(self._shapes)))

    def _pose(self, number: int) -> Pose:
        root = self._root[number]
        return Pose(self._data.xpos[root].copy(), self._data.xmat[root].reshape(3, 3).copy())

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes as they are now: a hinge may have moved."""
        return tuple(self._bent(number, shape) for number, shape in enumerate(self._shapes))

    def _bent(self, number: int, shape: Shape) -> Shape:
        if shape.hinge is None:
            return shape
        data, k, root = self._data, shape.hinge.first_part, self._root[number]
        outer, inner = (data.xmat[i].reshape(3, 3) for i in (root, root + 1))
        turn, shift = outer.T @ inner, outer.T @ (data.xpos[root + 1] - data.xpos[root])
        moved = [
            replace(p, position=turn @ p.position + shift, rotation=turn @ p.rotation) for p in shape.parts[k:]
        ]
        return replace(shape, parts=(*shape.parts[:k], *moved))

    def settle(self, longest: float = 4.0, still: float = 0.004) -> bool:
        """Step until nothing moves for a tenth of a second; False where that takes longer than `longest` seconds.

        Still means every speed below `still` m/s, and every turn below ten times that in rad/s.
        """
        limits = self._speed_limits(still)
        calm = 0
        while self._data.time < longest:
            self._mujoco.mj_step(self._model, self._data, _CHUNK)
            calm = calm + 1 if (np.abs(self._data.qvel) < limits).all() else 0
            if calm == 2:
                self._mujoco.mj_forward(self._model, self._data)
                return True
        return False

    def _speed_limits(self, still: float) -> NDArray[np.float64]:
        limits = np.full(self._model.nv, 10 * still)
        for joint, address in zip(self._model.jnt_type, self._model.jnt_dofadr, strict=True):
            if joint == self._mujoco.mjtJoint.mjJNT_FREE:
                limits[address : address + 3] = still
        return limits

    def contacts(self) -> Contacts:
        """All contacts and near misses between different bodies of the scene."""
        contact, n = self._data.contact, self._data.ncon
        forces = np.zeros((n, 3))
        frames = np.array(contact.frame).reshape(n, 3, 3)
        wrench = np.zeros(6)
        for i in range(n):
            self._mujoco.mj_contactForce(self._model, self._data, i, wrench)
            forces[i] = wrench[:3] @ frames[i]
        bodies = self._shape_of_geom[np.array(contact.geom).reshape(n, 2)]
        apart = bodies[:, 0] != bodies[:, 1]
        return Contacts(
            bodies[apart, 0],
            bodies[apart, 1],
            frames[apart, 0],
            forces[apart],
            np.array(contact.dist).reshape(n)[apart],
            np.array(contact.pos).reshape(n, 3)[apart],
        )

    def cast(
        self, origin: NDArray[np.float64], rays: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """Which shape each ray ``(m, 3)`` meets (−1 none; the table is not looked at), how many ray lengths away
        (infinite where none) and the surface normal there ``(m, 3)``."""
        m = len(rays)
        geoms, along, normals = np.full(m, -1, np.int32), np.zeros(m), np.zeros(3 * m)
        self._mujoco.mj_multiRay(
            self._model, self._data, origin, np.ascontiguousarray(rays).ravel(), _RAYS_GROUPS, 1, -1,
            geoms, along, normals, m, 1e10,
        )  # fmt: skip
        hit = geoms >= 0
        shapes = np.where(hit, self._shape_of_geom[geoms], -1)
        return shapes, np.where(hit, along, np.inf), normals.reshape(m, 3)

    def distance(self, a: int, b: int, farthest: float) -> tuple[float, NDArray[np.float64]]:
        """Smallest distance between two shapes and the vector from `a` to `b` along it; `farthest` where more."""
        model, data = self._model, self._data
        best, along, segment = farthest, np.zeros(3), np.zeros(6)
        reach = model.geom_rbound
        ours, theirs = (np.flatnonzero(self._shape_of_geom == i) for i in (a, b))
        apart = np.linalg.norm(data.geom_xpos[ours][:, None] - data.geom_xpos[theirs][None], axis=2)
        least = apart - reach[ours][:, None] - reach[theirs][None]
        for k in np.argsort(least, axis=None):
            i, j = np.unravel_index(k, least.shape)
            if least[i, j] >= best:
                break
            found = self._mujoco.mj_geomDistance(model, data, int(ours[i]), int(theirs[j]), best, segment)
            if found < best:
                best, along = float(found), segment[3:] - segment[:3]
        return best, along.copy()


def _mujoco() -> ModuleType:
    try:
        import mujoco
    except ImportError:
        raise MissingExtraError("the tabletop needs MuJoCo: pip install 'lifelore[sim]'") from None
    return mujoco


def _scene_xml(shapes: Sequence[Shape], poses: Sequence[Pose], tools: str) -> str:
    meshes, bodies = [], []
    for number, (shape, pose) in enumerate(zip(shapes, poses, strict=True)):
        geoms = []
        for index, part in enumerate(shape.parts):
            name = f"m{number}_{index}"
            if part.vertices is not None:
                meshes.append(f'<mesh name="{name}" vertex="{_numbers(part.vertices)}"/>')
            geoms.append(_geom_xml(part, name, shape.density))
        bodies.append(_body_xml(shape, pose, geoms, number))
    return (
        f'<mujoco><compiler angle="radian" balanceinertia="true"/>{_OPTIONS}'
        f"<asset>{''.join(meshes)}</asset><worldbody>"
        f'<geom type="plane" size="0 0 1" group="1"/>{"".join(bodies)}</worldbody>{tools}</mujoco>'
    )


def _body_xml(shape: Shape, pose: Pose, geoms: list[str], number: int) -> str:
    first, inner = geoms, ""
    if shape.hinge is not None:
        hinge = shape.hinge
        joint = (
            f'<joint type="hinge" pos="{_numbers(hinge.position)}" axis="{_numbers(hinge.axis)}" '
            f'range="{_numbers(hinge.limits)}" limited="true" damping="0.01" frictionloss="0.02"/>'
        )
        first, inner = geoms[: hinge.first_part], f"<body>{joint}{''.join(geoms[hinge.first_part :])}</body>"
    free = '<joint type="free" damping="0.0005"/>'
    frame = _frame(pose.position, pose.rotation)
    return f'<body name="thing{number}" {frame}>{free}{"".join(first)}{inner}</body>'


def _geom_xml(part: ShapePart, mesh: str, density: float) -> str:
    what = f'type="mesh" mesh="{mesh}"' if part.vertices is not None else f'type="{_TYPES[part.kind]}"'
    size = "" if part.vertices is not None else f'size="{_numbers(part.size)}"'
    return f'<geom {what} {size} {_frame(part.position, part.rotation)} density="{density:.9g}"/>'


def _frame(position: NDArray[np.float64], rotation: NDArray[np.float64]) -> str:
    return f'pos="{_numbers(position)}" xyaxes="{_numbers(rotation[:, :2].T)}"'


def _numbers(values: Any) -> str:
    return " ".join(f"{value:.9g}" for value in np.asarray(values, dtype=float).ravel())
