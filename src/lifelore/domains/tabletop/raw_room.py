"""Simulated raw frames: a settled tabletop in a room with floor, walls, shelf and furniture, as a Kinect sees it.

A frame is the whole picture of 640 × 480 pixels, not cropped, with range noise, quantised disparity and pixels
without depth. It has no labels; the truth is stored beside it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED
from lifelore.core.streams import stream
from lifelore.domains.tabletop.depth_camera import KINECT, looking_down, measure
from lifelore.domains.tabletop.furniture import Board, cast_boards, standing_table
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.settings import TabletopScene, TabletopSettings
from lifelore.domains.tabletop.tabletop import sample_scene

FEW_POINTS = 250
"""Least number of visible points of an object; a view that shows fewer of any object is drawn again."""
FARTHEST, NEAREST = 5.0, 0.45
"""Metres of depth within which the sensor measures."""
_GRAZING = 0.07
"""Least cosine between a ray and the surface's normal that gives a depth."""
_VIEWS = 60
TABLE_TOP = "table"


@dataclass(frozen=True, eq=False)
class RawRoom:
    """A raw frame in the camera's frame (x right, y down, z forward, metres), and its truth.

    Parameters
    ----------
    name, kind : str
        Its number as a name, and a key of `ROOMS`.
    points : (480 · 640, 3) float64
        Row by row; NaN without depth.
    colours : (480 · 640, 3) uint8
    labels : (480 · 640,) int64
        0 room or no depth, 1 the table's top, 2 … the objects on it.
    plane : (4,) float64, optional
        The table: n·p + d is the height above it. None where the frame shows no table.
    view : Pose
        The camera's pose in the table's frame.
    """

    name: str
    kind: str
    points: NDArray[np.float64]
    colours: NDArray[np.uint8]
    labels: NDArray[np.int64]
    plane: NDArray[np.float64] | None
    view: Pose

    @property
    def up(self) -> NDArray[np.float64]:
        """(3,) unit vector: upward in the camera's frame."""
        return self.view.rotation[2]


def raw_room(seed: int, number: int, kind: str | None = None) -> RawRoom:
    """Frame `number` of a seed; its `kind` is a key of `ROOMS`, by default each in turn.

    Raises
    ------
    MissingExtraError
        MuJoCo is not installed.
    InputError
        The kind is unknown.
    """
    kind = list(ROOMS)[number % len(ROOMS)] if kind is None else kind
    if kind not in ROOMS:
        raise InputError(f"kind must be one of {', '.join(ROOMS)}, got '{kind}'")
    scene = sample_scene(seed, number, TabletopSettings(n_objects=(2, 6), shapes="all"))
    for attempt in range(_VIEWS):
        rng = stream(seed, "tabletop raw room", kind, number, attempt)
        room = _frame(scene, f"room{number:05d}", kind, rng)
        if room is not None:
            return room
    raise InputError(f"no view of room {number} of seed {seed} shows all objects: choose another number")


def _frame(scene: TabletopScene, name: str, kind: str, rng: np.random.Generator) -> RawRoom | None:
    """One draw of the room and the view; None where an object is hidden or outside the picture."""
    outline = np.concatenate(
        [pose.apply(shape.outline()) for shape, pose in zip(scene.shapes, scene.poses, strict=True)]
    )
    boards, has_table = ROOMS[kind](rng, outline)
    view = _view(outline, rng)
    if view is None:
        return None
    rays = KINECT.rays(np.arange(KINECT.width)[None], np.arange(KINECT.height)[:, None])
    world = rays.reshape(-1, 3) @ view.rotation.T
    hits, depth, normals = Tabletop(scene.shapes, scene.poses).rigid().cast(view.position, world)
    board, further, faces = cast_boards(boards, view.position, world)
    behind = further < depth
    depth = np.minimum(depth, further)
    normals[behind] = faces[behind]
    slant = np.abs(np.einsum("ij,ij->i", normals, world)) / np.linalg.norm(world, axis=1)
    depth[(slant < _GRAZING) | (depth > FARTHEST) | (depth < NEAREST)] = np.inf
    measured = measure(depth.reshape(rays.shape[:2]), KINECT, rng).ravel()
    seen = np.isfinite(measured)
    top = np.array([b.kind == TABLE_TOP for b in boards])[board] & (faces[:, 2] > 0.5)
    labels = np.where(behind, np.where(top, TABLE, UNLABELLED), hits + FIRST_OBJECT)
    labels[~seen] = UNLABELLED
    counts = np.bincount(labels, minlength=FIRST_OBJECT + len(scene.shapes))[FIRST_OBJECT:]
    if counts.min() < FEW_POINTS:
        return None
    plane = np.append(view.rotation[2], view.position[2]) if has_table else None
    colours = _colours(np.where(behind, board, len(boards) + hits), normals, rng)
    return RawRoom(name, kind, rays.reshape(-1, 3) * measured[:, None], colours, labels, plane, view)


def _view(outline: NDArray[np.float64], rng: np.random.Generator) -> Pose | None:
    """A camera 0.8 to 1.8 m from the objects that looks 18° to 50° down; None where an object is outside."""
    middle = (outline.min(axis=0) + outline.max(axis=0)) / 2 * [1, 1, 0]
    tilt, roll = np.radians(rng.uniform(18, 50)), rng.normal(0, 0.03)
    far = rng.uniform(0.8, 1.8)
    aim = rng.normal(0, 0.08 * far, 2)
    view = looking_down(far * np.sin(tilt) + rng.uniform(0.0, 0.15), tilt, roll, far)
    view = view.moved(middle + np.append(aim, 0.0))
    local = (outline - view.position) @ view.rotation
    if local[:, 2].min() < 0.5:
        return None
    pixels = KINECT.project(local)
    inside = (pixels > 6).all() and (pixels < [KINECT.width - 6, KINECT.height - 6]).all()
    return view if inside else None


def _colours(
    surfaces: NDArray[np.int64], normals: NDArray[np.float64], rng: np.random.Generator
) -> NDArray[np.uint8]:
    palette = rng.uniform(40, 235, (int(surfaces.max()) + 1, 3))
    light = 0.55 + 0.45 * np.clip(normals @ np.array([0.3, -0.4, 0.866]), 0, 1)
    noisy = palette[surfaces] * light[:, None] + rng.normal(0, 4, (len(surfaces), 1))
    return np.clip(noisy, 0, 255).astype(np.uint8)


Furnished = tuple[list[Board], bool]
"""The boards of a room, and whether the table's top can be seen by the sensor."""


def _room(rng: np.random.Generator, outline: NDArray[np.float64], gap: tuple[float, float]) -> Furnished:
    """A table with the objects, the floor, a back wall `gap` metres behind the table, and a side wall."""
    low, high = outline[:, :2].min(axis=0), outline[:, :2].max(axis=0)
    middle, size = (low + high) / 2, (high - low) / 2
    half = np.maximum(rng.uniform((0.3, 0.25), (0.8, 0.45)), size + 0.08)
    spare = half - size - 0.06
    x, y = middle + rng.uniform(-1, 1, 2) * spare
    floor, yaw = -rng.uniform(0.45, 0.95), rng.normal(0, 0.12)
    boards = standing_table(TABLE_TOP, x, y, 0.0, floor, (half[0], half[1]), yaw, rng.uniform(0.018, 0.045))
    back = y + half[1] * np.cos(yaw) + half[0] * abs(np.sin(yaw)) + rng.uniform(*gap)
    side = x + rng.choice([-1, 1]) * (half[0] + rng.uniform(0.1, 1.2))
    boards.append(Board("floor", (0.0, 0.0, floor - 0.05), (6.0, 6.0, 0.05)))
    boards.append(Board("wall", (0.0, back + 0.05, floor + 1.3), (6.0, 0.05, 1.3)))
    boards.append(Board("wall", (side + np.sign(side) * 0.25, 0.0, floor + 1.3), (0.05, 6.0, 1.3)))
    return boards, True


def _plain(rng: np.random.Generator, outline: NDArray[np.float64]) -> Furnished:
    return _room(rng, outline, (0.3, 1.5))


def _against_wall(rng: np.random.Generator, outline: NDArray[np.float64]) -> Furnished:
    return _room(rng, outline, (0.0, 0.01))


def _with_shelf(rng: np.random.Generator, outline: NDArray[np.float64]) -> Furnished:
    """Two shelf boards with boxes on the wall behind the table."""
    boards, has_table = _room(rng, outline, (0.0, 0.3))
    wall = next(board for board in boards if board.kind == "wall")
    front = wall.middle[1] - wall.half[1]
    for height in (rng.uniform(0.3, 0.45), rng.uniform(0.7, 0.85)):
        x = rng.normal(0, 0.2)
        boards.append(Board("shelf", (x, front - 0.12, height), (rng.uniform(0.3, 0.6), 0.12, 0.01)))
        boards += _boxes(
            rng, int(rng.integers(1, 4)), (x - 0.25, front - 0.17), (x + 0.25, front - 0.1), height + 0.01
        )
    return boards, has_table


def _with_furniture(rng: np.random.Generator, outline: NDArray[np.float64]) -> Furnished:
    """A cabinet and a second table behind the table, boxes on both, a chair, and boxes on the floor."""
    boards, has_table = _room(rng, outline, (1.0, 2.0))
    table, wall = boards[0], next(board for board in boards if board.kind == "wall")
    floor = boards[1].middle[2] - boards[1].half[2]
    behind = table.middle[1] + table.half[1]
    height = floor + rng.uniform(0.5, 1.1)
    x, side = rng.uniform(-0.6, 0.6), rng.choice([-1, 1])
    y = wall.middle[1] - 0.3
    boards.append(Board("cabinet", (x, y, (floor + height) / 2), (0.4, 0.22, (height - floor) / 2)))
    boards += _boxes(rng, 2, (x - 0.3, y - 0.1), (x + 0.3, y + 0.1), height)
    boards += standing_table("second table", x + side * 1.2, y - 0.1, floor + 0.72, floor, (0.4, 0.3), 0.0, 0.03)
    boards += _boxes(rng, 2, (x + side * 1.2 - 0.2, y - 0.2), (x + side * 1.2 + 0.2, y), floor + 0.72)
    chair = (rng.uniform(-0.5, 0.5), behind + 0.35)
    boards += standing_table("chair", *chair, floor + 0.45, floor, (0.2, 0.2), 0.2, 0.03)
    boards.append(Board("chair", (chair[0], chair[1] + 0.18, floor + 0.68), (0.2, 0.015, 0.22), 0.2))
    boards += _boxes(rng, 3, (-0.9, behind + 0.1), (0.9, behind + 0.8), floor)
    return boards, has_table


def _glass_table(rng: np.random.Generator, outline: NDArray[np.float64]) -> Furnished:
    """The top gives no depth: the objects hover over the floor."""
    boards, _ = _room(rng, outline, (0.3, 1.5))
    return [board for board in boards if board.kind != TABLE_TOP], False


def _boxes(
    rng: np.random.Generator, n: int, low: tuple[float, float], high: tuple[float, float], bottom: float
) -> list[Board]:
    boxes = []
    for _ in range(n):
        half = rng.uniform((0.03, 0.03, 0.04), (0.09, 0.07, 0.13))
        x, y = rng.uniform(low, high)
        boxes.append(
            Board("box", (x, y, bottom + half[2]), (half[0], half[1], half[2]), float(rng.uniform(0, np.pi)))
        )
    return boxes


ROOMS: Mapping[str, Callable[[np.random.Generator, NDArray[np.float64]], Furnished]] = {
    "plain": _plain,
    "against a wall": _against_wall,
    "shelf": _with_shelf,
    "furniture": _with_furniture,
    "glass table": _glass_table,
}
"""Kinds of rooms. The table of the last kind gives no depth."""
