"""Warnings of a scene: signs that its table, its up direction, its objects or its units may be wrong."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.clouds.cloud_scale import unit_hint
from lifelore.perception.segmentation.dropped_points import dropped_points
from lifelore.perception.segmentation.range_noise import band
from lifelore.perception.segmentation.table_frame import SegmentedScene

TINY = 0.02
"""Metres; an object smaller in all directions is tiny."""
_TINY_SHARE = 0.5
SURE = 0.8
"""Confidence of a cut below which an object is named as doubtful."""
_FEW_TABLE_SHARE = 0.05
GAP = 0.03
"""Metres beyond the table's band; a larger gap between the table and the lowest object is a warning."""
NARROW, WIDE = 0.25, 12.0
"""Metres: widths of a scene below and above which its units are doubted; a Kinect's table is about 1 m wide."""
NEAREST = 0.15
"""Metres: median range below which the units are doubted; depth cameras measure from about 0.3 m."""

FACING = 25.0
"""Degrees between the table's normal and the direction to the camera below which the table may be a wall; 44° to
51° on tables that a camera looks at from the side."""
FEW_POINTS = 30
"""Points of an object; with fewer its contacts and relations are a guess."""


@dataclass(frozen=True)
class SceneWarning:
    """A warning: a `code` for programs, a `message` of one line for people."""

    code: str
    message: str


def scene_warnings(scene: SegmentedScene) -> tuple[SceneWarning, ...]:
    """The warnings of a scene, the most fundamental first; empty for a labelled scene without a doubt.

    Codes: ``units``, ``camera_doubted``, ``up_not_level``, ``no_table``, ``table_faces_camera``, ``table_empty``,
    ``few_table_points``, ``table_gap``, ``points_dropped``, ``tiny_objects``, ``few_object_points``,
    ``automatic_objects``.
    """
    dropped = dropped_points(scene)
    found = [*_units(scene), *_camera(scene), *_table(scene)]
    found += ([] if dropped is None else [("points_dropped", dropped)]) + _objects(scene)
    return tuple(SceneWarning(code, message) for code, message in found)


def _units(scene: SegmentedScene) -> list[tuple[str, str]]:
    points, camera = scene.cloud.points, scene.cloud.camera
    low, high = np.percentile(points[:: max(1, len(points) // 20_000)], (1, 99), axis=0)
    width = float(np.max(high - low))
    wrong = [f"is {100 * width:.3g} cm wide"] if width < NARROW else []
    if width > WIDE:
        wrong = [f"is {width:.3g} m wide"]
    if camera is not None and np.abs(camera).max() < WIDE:
        away = float(np.median(np.linalg.norm(points - camera, axis=1)))
        if 0 < away < NEAREST:
            wrong.append(f"is seen from {100 * away:.3g} cm")
    if not wrong:
        return []
    return [("units", f"the scene {' and '.join(wrong)}: {unit_hint(width)}")]


def _camera(scene: SegmentedScene) -> list[tuple[str, str]]:
    if scene.camera_doubt is None:
        return []
    instead = "its place was computed from the pixels of the image"
    if scene.cloud.camera is None:
        instead = (
            "it counts as unknown, so that hidden tops are not noticed. Give its place in the cloud's frame"
            " (VIEWPOINT of a PCD, camera of an npz)"
        )
    return [("camera_doubted", f"the camera cannot be where the cloud says: {scene.camera_doubt}; {instead}")]


def _table(scene: SegmentedScene) -> list[tuple[str, str]]:
    labels = scene.cloud.labels
    if not scene.automatic and not (labels == TABLE).any():
        return []
    if scene.automatic and scene.table is None:
        return _missing_table(scene)
    found = [] if scene.up_given or not scene.automatic else _facing(scene)
    if scene.table is not None and scene.table.standing == 0:
        text = "nothing stands on the plane that was taken for the table; if it is not, pass --up X,Y,Z"
        found.append(("table_empty", text))
    share = float(np.mean(labels == TABLE))
    if share < _FEW_TABLE_SHARE:
        text = (
            f"only {100 * share:.1f} % of the points lie on the table; check up (--up), or crop the cloud (--roi)"
        )
        found.append(("few_table_points", text))
    return found + _gap(scene)


def _facing(scene: SegmentedScene) -> list[tuple[str, str]]:
    """A warning where the table's normal points at the camera, as a wall's does."""
    if scene.cloud.camera is None:
        return []
    away = scene.cloud.points.mean(axis=0) - scene.cloud.camera
    angle = float(np.degrees(np.arccos(np.clip(-away[2] / np.linalg.norm(away), -1, 1))))
    if angle >= FACING:
        return []
    text = (
        f"the plane that was taken for the table faces the camera ({angle:.0f}° off), as a wall does; unless the"
        " camera looks straight down, pass --up X,Y,Z"
    )
    return [("table_faces_camera", text)]


def _missing_table(scene: SegmentedScene) -> list[tuple[str, str]]:
    missing = ("no_table", "no table was found: objects are cut without it, and their support is unknown")
    hint = "check --up, or leave it out so that the table's normal is taken"
    if scene.tilted is not None:
        x, y, z = scene.tilted
        hint = (
            f"objects stand on a plane with the normal {x:.3f},{y:.3f},{z:.3f}: try --up={x:.3f},{y:.3f},{z:.3f}"
        )
    return [("up_not_level", f"no plane with objects on it is level with the given up; {hint}"), missing]


def _gap(scene: SegmentedScene) -> list[tuple[str, str]]:
    """A warning where even the lowest object begins above the table, or most objects lie below it."""
    bottoms, middles = [], []
    for label in scene.cloud.objects:
        heights = scene.cloud.of(label)[:, 2]
        bottoms.append(float(np.percentile(heights, 1)))
        middles.append(float(np.median(heights)))
    if not bottoms:
        return []
    if np.median(middles) < 0:
        text = "most objects lie below the table's plane; up may point downwards: give it (--up X,Y,Z)"
        return [("table_gap", text)]
    allowed = GAP + _band(scene)
    if min(bottoms) > allowed:
        text = f"the lowest object begins {100 * min(bottoms):.0f} cm above the table; it may not be the table"
        return [("table_gap", text)]
    return []


def _band(scene: SegmentedScene) -> float:
    """Median half width of the table's band over the points of objects, metres."""
    objects = scene.cloud.points[scene.cloud.labels > TABLE]
    return float(np.median(band(objects[::50], scene.cloud.camera)))


def _objects(scene: SegmentedScene) -> list[tuple[str, str]]:
    found = []
    if not scene.automatic and not scene.cloud.objects:
        text = "no point has the label of an object: objects are numbered from 2 (0 is no object, 1 is the table)"
        found.append(("table_empty", text))
    sizes: list[NDArray[np.float64]] = [np.ptp(scene.cloud.of(label), axis=0) for label in scene.cloud.objects]
    tiny = sum(float(size.max()) < TINY for size in sizes)
    if sizes and tiny > _TINY_SHARE * len(sizes):
        text = (
            f"{tiny} of {len(sizes)} objects are smaller than {100 * TINY:.0f} cm; check the units and the labels"
        )
        found.append(("tiny_objects", text))
    counts = np.bincount(scene.cloud.labels)
    few = {label: int(counts[label]) for label in scene.cloud.objects if counts[label] < FEW_POINTS}
    if few:
        named = ", ".join(f"{label} ({n})" for label, n in few.items())
        text = f"objects with fewer than {FEW_POINTS} points, whose relations are a guess: {named}"
        found.append(("few_object_points", text))
    if scene.automatic and sizes:
        found.append(("automatic_objects", _automatic(len(sizes), scene)))
    return found


def _automatic(n: int, scene: SegmentedScene) -> str:
    doubtful = [label for label, confidence in scene.confidence.items() if confidence < SURE]
    were_cut = f"{n} object{' was' if n == 1 else 's were'} cut automatically"
    if not scene.confidence:
        return f"{were_cut}; objects that touch may be merged: labels are surer"
    if not doubtful:
        return f"{were_cut}, each with a confidence of at least {SURE:g}"
    named = ", ".join(map(str, doubtful))
    return f"{were_cut}; {len(doubtful)} of them with a confidence below {SURE:g}: {named}"
