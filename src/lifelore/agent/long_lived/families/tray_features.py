"""Deictic features of a tray: what lies on the target, beside it and under it, from perceived relations."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import BOTH, ON
from lifelore.domains.tabletop_job.job import TabletopJob
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.scene import Scene
from lifelore.perception.segmentation.table_frame import to_scene

SURE = 0.8
"""Confidence from which something is held to be on the target; below it, it may be there."""
NEAR, TOUCHING = 0.045, 0.02
"""Metres between the visible points of neighbours: near enough for a finger to matter, and side by side."""


@dataclass(frozen=True)
class TrayFeatures:
    """What is around the target. Objects are named as the gripper points at them.

    Parameters
    ----------
    above : int
        0: nothing on the target; 1: something may be on it; 2: an object is; 3: a stack of two or more is.
    beside : int
        0: nothing near; 1: a neighbour is near; 2: a neighbour touches.
    below : int
        1 if the target rests on another object.
    target : int
    top : int or None
        The highest object of what is on the target.
    neighbour : int or None
        The nearest other object beside the target.
    """

    above: int
    beside: int
    below: int
    target: int
    top: int | None
    neighbour: int | None


def look_with_labels(job: TabletopJob) -> TrayFeatures | None:
    """The features of what the camera sees, with the labels of the points given; None if the target is hidden."""
    return _features(job, job.look(labelled=True, coloured=False))


def look_at_raw_cloud(job: TabletopJob) -> TrayFeatures | None:
    """The features of what the camera sees, objects cut automatically.

    None if the target is hidden, or if no scene can be made of the cloud: it shows too little of the table.
    """
    seen = job.look()
    if len(seen.points) == 0:
        return None
    try:
        # The camera knows which way is up; the frame stays that of the table.
        cloud = to_scene(PointCloud(seen.points, colours=seen.colours, camera=seen.camera), "z")
    except InputError:
        return None
    return _features(job, cloud)


def look_without_relations(job: TabletopJob) -> TrayFeatures | None:
    """What is left without perception of relations: the target, and the object nearest to it."""
    here = [k for k in range(job.n_objects) if k not in job.observation.gone and k != job.observation.held]
    if job.tray.target not in here:
        return None
    middle = job.poses[job.tray.target].position
    others = sorted(
        (k for k in here if k != job.tray.target),
        key=lambda k: float(np.linalg.norm(job.poses[k].position - middle)),
    )
    nearest = others[0] if others else None
    return TrayFeatures(0, int(nearest is not None), 0, job.tray.target, None, nearest)


def _features(job: TabletopJob, cloud: LabelledCloud) -> TrayFeatures | None:
    held = job.observation.held
    parts = {label: cloud.points[cloud.labels == label] for label in cloud.objects}
    if not parts:
        return None
    scene = perceived_scene(cloud)
    pointed = job.tray.pointed if job.observation.n_actions_taken == 0 else job.poses[job.tray.target].position
    target = min(parts, key=lambda label: float(np.linalg.norm(parts[label] - pointed, axis=1).min()))
    number = {label: job.object_at(_nearest_to_middle(points)) for label, points in parts.items()}
    number[target] = job.tray.target
    if held is not None:
        parts = {label: points for label, points in parts.items() if number[label] != held}
    return tray_features(scene, target, parts, number)


def tray_features(
    scene: Scene, target: int, parts: dict[int, NDArray[np.float64]], number: dict[int, int]
) -> TrayFeatures:
    """The features of a perceived scene.

    Parameters
    ----------
    target : int
        Label of the target.
    parts : dict of int to (n, 3) float64
        Points of each label that counts.
    number : dict of int to int
        The object that the gripper grasps where it points at a label.
    """
    rests = [(r.a, r.b, r.confidence) for r in scene.relations if r.relation in (ON, BOTH) and r.b != TABLE]
    above, level, chain = 0, [target], [target]
    sure = 0.0
    while level := [a for a, b, _ in rests if b in level and a not in chain and a in parts]:
        if above == 0:
            sure = max(c for a, b, c in rests if b == target and a in level)
        above += 1
        chain += level
    kind = 0 if above == 0 else 1 if sure < SURE else 2 if above == 1 else 3
    below = [b for a, b, _ in rests if a == target and b in parts]
    tree = KDTree(parts[target]) if target in parts else None
    # Beyond `NEAR` a gap is infinite: how large it is does not matter.
    gaps = {
        label: float(tree.query(points, distance_upper_bound=NEAR)[0].min())
        for label, points in parts.items()
        if tree is not None and label not in (*chain, *below)
    }
    nearest = min(gaps, key=gaps.__getitem__, default=None)
    gap = np.inf if nearest is None else gaps[nearest]
    beside = 2 if gap <= TOUCHING else 1 if gap <= NEAR else 0
    top = max(chain[1:], key=lambda label: float(np.median(parts[label][:, 2])), default=None)
    return TrayFeatures(
        kind,
        beside,
        int(bool(below)),
        number[target],
        None if top is None else number[top],
        number[nearest] if nearest is not None and beside else None,
    )


def _nearest_to_middle(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return points[np.linalg.norm(points - np.median(points, axis=0), axis=1).argmin()]
