"""`bench raw_frames`: the table and the objects found in simulated raw frames of whole rooms, without labels."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_least, at_most, row
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.tabletop.raw_room import ROOMS, RawRoom, raw_room
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.plane import Plane, dominant_plane
from lifelore.perception.segmentation.table_frame import segmented_scene

SEED = 7101
MOST_ANGLE, MOST_HEIGHT = 2.0, 0.01
"""Degrees between the planes' normals and metres between them at the table's middle, for the right table."""
OVERLAP = 0.5
"""Least intersection over union of an object that is found."""
LARGEST, OURS = "largest plane", "evidence"


@dataclass(frozen=True)
class Judged:
    """What was found in a frame: is the table right, is it false, objects found, cut and true.

    In a frame without a visible table, finding none is right, and any table is false.
    """

    right: bool
    false: bool
    found: int = 0
    cut: int = 0
    true: int = 0


def bench_raw_frames(repeats: int, progress: Progress) -> dict:
    """Rows and goals over `repeats` rooms of each kind; see `benchmarks.bench`."""
    judged: dict[str, dict[str, list[Judged]]] = {kind: {LARGEST: [], OURS: []} for kind in ROOMS}
    total = repeats * len(ROOMS)
    for number in range(total):
        room = raw_room(SEED, number)
        judged[room.kind][LARGEST].append(_largest(room))
        judged[room.kind][OURS].append(_ours(room))
        progress(number + 1, total, room.kind)
    rows = [line for kind in ROOMS for line in _rows(kind, repeats, judged[kind])]
    everything = {way: [entry for kind in ROOMS for entry in judged[kind][way]] for way in (LARGEST, OURS)}
    rows += _rows("all rooms", total, everything)
    ours = everything[OURS]
    goals = [
        at_least("share of rooms with the right table, or rightly none", 0.95, _share(j.right for j in ours)),
        at_most("share of rooms with a false table", 0.05, _share(j.false for j in ours)),
        at_most("most objects cut from a frame", 60, max(j.cut for j in ours)),
    ]
    return {"rows": rows, "goals": goals}


def _rows(name: str, n: int, judged: dict[str, list[Judged]]) -> list[dict]:
    rows = []
    for way, entries in judged.items():
        rows.append(row(f"{name}, {n} frames, {way}: right", _share(j.right for j in entries), "share"))
        rows.append(row(f"{name}, {way}: false table", _share(j.false for j in entries), "share"))
    ours = judged[OURS]
    for part in ("true", "cut", "found"):
        rows.append(row(f"{name}: objects {part}", sum(getattr(j, part) for j in ours), "objects"))
    return rows


def _share(flags: Iterable[bool]) -> float:
    return float(np.mean(list(flags)))


def _largest(room: RawRoom) -> Judged:
    """The plane with most points, whichever it is; the side of the camera is up."""
    points = room.points[np.isfinite(room.points[:, 2])]
    try:
        plane, _ = dominant_plane(points, stream(0, "perception", "table plane"))
    except InputError:
        return Judged(room.plane is None, False)
    right = _is_right(plane if plane.offset >= 0 else plane.flipped(), room)
    return Judged(right, not right)


def _ours(room: RawRoom) -> Judged:
    cloud = PointCloud(room.points, None, room.colours, (480, 640), np.zeros(3))
    truth = room.labels[cloud.measured]
    n = len(np.unique(truth[truth > TABLE]))
    try:
        scene = segmented_scene(cloud)
    except InputError as error:
        # Too many objects is neither a table nor an answer.
        return Judged(room.plane is None and "no table" in str(error), False, 0, 0, n)
    assert scene.table is not None
    right = _is_right(scene.table.plane, room)
    found = _found(scene.cloud.labels, truth)
    return Judged(right, not right, found, len(scene.cloud.objects), n)


def _is_right(plane: Plane, room: RawRoom) -> bool:
    if room.plane is None:
        return False
    top = room.points[room.labels == TABLE]
    cosine = float(np.clip(plane.normal @ room.plane[:3], -1, 1))
    apart = abs(float(np.median(plane.height(top) - (top @ room.plane[:3] + room.plane[3]))))
    return np.degrees(np.arccos(cosine)) <= MOST_ANGLE and apart <= MOST_HEIGHT


def _found(labels: NDArray[np.int64], truth: NDArray[np.int64]) -> int:
    """True objects that a cut object overlaps by at least `OVERLAP`."""
    found = 0
    for label in np.unique(truth[truth > TABLE]):
        mine = truth == label
        ours = np.bincount(labels[mine]) if mine.any() else np.zeros(1)
        ours[: TABLE + 1] = 0
        best = int(ours.argmax())
        if ours[best]:
            found += ours[best] / (np.count_nonzero(labels == best) + mine.sum() - ours[best]) >= OVERLAP
    return int(found)
