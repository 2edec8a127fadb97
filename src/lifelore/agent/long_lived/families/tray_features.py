"""Deictic features of a tray: what an object carries, whether fingers find room beside it, whether it would tip.

Features are of one object among those that are still on the tray, so that the agent can ask what they will be when
another is gone. They are measured on perceived relations and on the points that the camera sees.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.agent.long_lived.families.finger_room import Grasp, grasp_of, reach_into
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import BOTH, ON
from lifelore.domains.tabletop_job.job import TabletopJob
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.scene import Scene
from lifelore.perception.scene_perception import perceived_scene
from lifelore.perception.segmentation.table_frame import to_scene

Array = NDArray[np.float64]

FINGERS = (0.008, 0.03)
"""Metres: thicknesses of fingers that the agent's grippers come with; which it has today is hidden."""
LOADS = (0.02, 0.1, 0.5)
"""Probabilities of a load at which one class of `load` ends and the next begins."""
CARRIED = 0.1
"""Probability from which an object counts as lying on another where objects are named."""
TALL = 1.5
"""Height in widths of the narrowest side from which a pushed object may tip."""
NEAR = 0.08
"""Metres between visible points up to which an object may be in the way."""
MOST_POINTS = 1500
"""Points of an object that are kept; more cost time and measure no better than the camera's noise."""


@dataclass(frozen=True, eq=False)
class PerceivedTray:
    """A tray as perceived. Objects are named as the gripper points at them.

    Parameters
    ----------
    target : int
    points : dict of int to (n, 3) float
        Seen points of each object, metres.
    carries : dict of (int, int) to float
        Probability that the second object carries part of the first's weight; 0 where left out.
    related : bool
        Whether relations were perceived; without, every object is taken to be free.
    """

    target: int
    points: Mapping[int, NDArray[np.floating]]
    carries: dict[tuple[int, int], float]
    related: bool = True

    @cached_property
    def objects(self) -> frozenset[int]:
        """All objects that are seen."""
        return frozenset(self.points)

    def load(self, number: int, here: Iterable[int]) -> int:
        """Class of the probability that something `here` lies on an object: 0 (nothing) to 3 (something)."""
        free = float(np.prod([1 - self.carries.get((other, number), 0.0) for other in here if other != number]))
        return int(np.searchsorted(LOADS, 1 - free, side="right"))

    def room(self, number: int, here: Iterable[int]) -> int:
        """0: fingers of all thicknesses go down beside an object; 1: thin ones alone; 2: something stops all."""
        if not self.related:
            return 0
        reach = [self._reach[number, other] for other in here if (number, other) in self._reach]
        return int((np.max(reach, axis=0) > 0).sum()) if reach else 0

    def tall(self, number: int) -> bool:
        """Whether an object may tip when it is pushed."""
        if not self.related:
            return False
        grasp, points = self._grasps[number], self.points[number]
        height = float(points[:, 2].max()) - self._lowest(number)
        return height > TALL * max(grasp.ends[1] - grasp.ends[0], 0.01)

    def rests_on(self, number: int, here: Iterable[int]) -> list[int]:
        """Objects that carry an object."""
        return [other for other in here if self.carries.get((number, other), 0.0) >= CARRIED]

    def pile(self, number: int, here: Iterable[int]) -> frozenset[int]:
        """Objects that lie on an object, directly or on one another."""
        here, found = frozenset(here) - {number}, set[int]()
        level = {number}
        while level := {a for a in here - found if any(self.carries.get((a, b), 0.0) >= CARRIED for b in level)}:
            found |= level
        return frozenset(found)

    def hinders(self, other: int, number: int, here: Iterable[int]) -> bool:
        """Whether an object lies on another, or is so near that a finger beside the other may meet it."""
        reach = self._reach.get((number, other))
        near = reach is not None and float(reach[-1]) > -FINGERS[-1]
        return near or other in self.pile(number, {*here, other})

    def top(self, here: frozenset[int]) -> int | None:
        """The highest object of the pile on the target."""
        return max(self.pile(self.target, here), key=self._height, default=None)

    def neighbours(self, here: frozenset[int]) -> list[int]:
        """Objects beside the target: those in the fingers' way first, the deepest first, then by distance."""
        target = self.target
        beside = here - {target} - self.pile(target, here) - set(self.rests_on(target, here))
        near = [other for other in beside if self._gaps[other] <= NEAR]
        depth = {other: max(float(self._reach[target, other][-1]), 0.0) for other in near}
        return sorted(near, key=lambda other: (-depth[other], self._gaps[other]))

    # ---- measures of pairs, each made once --------------------------------------------------------

    def _height(self, number: int) -> float:
        return float(np.median(self.points[number][:, 2]))

    def _lowest(self, number: int) -> float:
        """The table, unless an object rests on another: what is hidden of it reaches down to what carries it."""
        return float(self.points[number][:, 2].min()) if self.rests_on(number, self.objects) else 0.0

    @cached_property
    def _grasps(self) -> dict[int, Grasp]:
        return {number: grasp_of(points, self._lowest(number)) for number, points in self.points.items()}

    @cached_property
    def _reach(self) -> dict[tuple[int, int], Array]:
        """How far the points of the second object reach into fingers at the first, by thickness, metres."""
        none = np.full(len(FINGERS), -np.inf)
        return {
            (a, b): reach_into(self._grasps[a], self.points[b], FINGERS) if self.related else none
            for a in self.points
            for b in self.points
            if a != b
        }

    @cached_property
    def _gaps(self) -> dict[int, float]:
        """Metres from the target's points to those of each other object."""
        tree = KDTree(self.points[self.target])
        return {other: float(tree.query(points)[0].min()) for other, points in self.points.items()}


def look_at_raw_cloud(job: TabletopJob) -> PerceivedTray | None:
    """The tray that the camera sees, objects cut automatically.

    None if the target is hidden, or if no scene can be made of the cloud: it shows too little of the table.
    """
    seen = job.look()
    if len(seen.points) == 0:
        return None
    try:
        # The camera knows which way is up; the frame stays that of the table.
        cloud = to_scene(PointCloud(seen.points, camera=seen.camera), "z")
    except InputError:
        return None
    return _perceived(job, cloud)


def look_without_relations(job: TabletopJob) -> PerceivedTray | None:
    """What is left without perception of relations: where the objects are."""
    here = [k for k in range(job.n_objects) if k not in job.observation.gone and k != job.observation.held]
    if job.tray.target not in here:
        return None
    # All are near: which of them is the nearest is all that is known.
    middle = job.poses[job.tray.target].position
    places = {k: 0.1 * NEAR * (job.poses[k].position - middle)[None] for k in here}
    return PerceivedTray(job.tray.target, places, {}, related=False)


def _perceived(job: TabletopJob, cloud: LabelledCloud) -> PerceivedTray | None:
    parts = {label: cloud.points[cloud.labels == label] for label in cloud.objects}
    if not parts:
        return None
    pointed = job.tray.pointed if job.observation.n_actions_taken == 0 else job.poses[job.tray.target].position
    target = min(parts, key=lambda label: float(np.linalg.norm(parts[label] - pointed, axis=1).min()))
    number = {label: job.object_at(_nearest_to_middle(points)) for label, points in parts.items()}
    number[target] = job.tray.target
    return tray_of_scene(perceived_scene(cloud), number, job.tray.target, job.observation.held)


def tray_of_scene(scene: Scene, number: dict[int, int], target: int, held: int | None = None) -> PerceivedTray:
    """The tray in a perceived scene.

    Parameters
    ----------
    number : dict of int to int
        The object that the gripper grasps where it points at a label; labels of one object are its parts.
    target : int
    held : int, optional
        What the hand holds is no part of the tray.
    """
    cloud, points = scene.cloud, dict[int, list[Array]]()
    for label, name in number.items():
        if name != held:
            points.setdefault(name, []).append(cloud.points[cloud.labels == label])
    carries: dict[tuple[int, int], float] = {}

    def carried(a: int, b: int, probability: float) -> None:
        pair = number.get(a, -1), number.get(b, -1)
        if pair[0] != pair[1] and pair[0] in points and pair[1] in points:
            carries[pair] = max(carries.get(pair, 0.0), probability)

    for belief in scene.beliefs:
        for prefix, a, b in (("", belief.a, belief.b), ("~", belief.b, belief.a)):
            carried(a, b, sum(belief.shares.get(prefix + name, 0.0) for name in (ON, BOTH)))
    for relation in scene.relations:
        if relation.relation in (ON, BOTH) and relation.b != TABLE:
            carried(relation.a, relation.b, relation.confidence)
    seen = {name: _thinned(np.concatenate(parts)) for name, parts in points.items()}
    return PerceivedTray(target, seen, carries)


def _thinned(points: Array) -> NDArray[np.floating]:
    every = max(1, len(points) // MOST_POINTS)
    return points[::every].astype(np.float32)


def _nearest_to_middle(points: Array) -> Array:
    return points[np.linalg.norm(points - np.median(points, axis=0), axis=1).argmin()]
