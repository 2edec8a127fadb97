"""`PokedPatches`: patches of a first cloud's surface, and the rigid motion of each at every push.

For each push the motions are found that explain the picture after it: registrations of the segments whose surface
is no longer where it was, each patch being assigned to rest or to a motion (`motion_labels`), and carried along.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.clouds.fused_views import moved
from lifelore.perception.registration.refinement import refined_motion
from lifelore.perception.segmentation.supervoxels import step_costs, supervoxels
from lifelore.perception.segmentation.surface_voxels import SurfaceVoxels, surface_voxels
from reproduction.chapter5.c5_07_poking.motion_labels import motion_labels
from reproduction.chapter5.c5_07_poking.moved_surface import VOXEL, ViewAfter, view_of

PATCH = 0.015
"""Metres between the seeds of patches: the resolution of a split."""
BORDER = 0.25
"""Cost of each pair of neighbouring voxels with different motions, in voxels of evidence; more splits less."""
CREASE = 0.4
"""Share of that cost where the first segmentation cuts."""
MOVED = 0.008
"""Metres; patches that moved less are still."""
LEAST_EVIDENCE = 25.0
"""Voxels (0.25 cm² each) of evidence that a further motion must explain."""
DECIDED, LEAST_DECIDED = 0.04, 8.0
"""Share of a part's voxels, and number of voxels, by which two motions must differ to be told apart."""
FARTHEST = 2.0
"""Largest step of a followed patch, in lengths of the push: what rolls or falls over is lost."""
DOUBTFUL, LOST = 0.2, 0.35
"""Mean cost of a segment's voxels above which a push tells nothing about it, and above which it is lost."""
MOST_MOTIONS = 4
"""Motions of one push beside rest."""
STEEP = 0.5
"""Largest vertical part of a unit normal of a surface that is pushed."""
ASIDE = 0.3
"""Largest angle between a push and the surface's normal, radians; a fingertip glances off at a larger one."""
_SAMPLE = 500
_MOST_VOXELS = 40_000
_TURNS = (0.0, -0.35, 0.35)
"""Radians about the vertical at which a registration starts."""
STILL = np.eye(4)
Motion = NDArray[np.float64]
"""A rigid motion (4, 4), metres."""


@dataclass(frozen=True)
class Poke:
    """A push of a fingertip.

    Parameters
    ----------
    place : (3,) float64
        Point of the surface that is touched, metres.
    push : (3,) float64
        Way of the fingertip after the touch, metres.
    """

    place: NDArray[np.float64]
    push: NDArray[np.float64]


class PokedPatches:
    """Patches of a first cloud's segments, followed through pushes.

    Parameters
    ----------
    cloud : LabelledCloud
        Before the first push, with its camera (emptiness is seen along its lines of sight) and the labels of a
        segmentation: 1 the table, from 2 segments. Other points take no part.
    """

    def __init__(self, cloud: LabelledCloud) -> None:
        assert cloud.camera is not None
        self.first = cloud
        self._rows = np.flatnonzero(cloud.labels > TABLE)
        self._motions: list[NDArray[np.int64]] = []
        self._costs: list[NDArray[np.float64]] = []
        self._touched: list[int] = []
        if not len(self._rows):
            self._surface, self._segment = None, np.empty(0, np.int64)
            return
        self._surface = surface_voxels(cloud.points[self._rows], cloud.camera, VOXEL, _MOST_VOXELS)
        self._make_patches(cloud.labels[self._rows])
        self._pose = np.tile(STILL, (len(self._counts), 1, 1))
        self._seen = np.ones(len(self._counts), bool)

    def _make_patches(self, labels: NDArray[np.int64]) -> None:
        """Patches that each lie in a single segment, and the borders between them."""
        surface = self._surface
        assert surface is not None
        of_voxel = _majority(surface.inverse, labels, len(surface.points))
        inner = of_voxel[surface.pairs[:, 0]] == of_voxel[surface.pairs[:, 1]]
        cut = SurfaceVoxels(surface.points, surface.normals, surface.pairs[inner], surface.inverse, surface.size)
        spacing = PATCH * surface.size / VOXEL
        patches = supervoxels(cut, step_costs(cut, spacing), spacing)
        mixed = patches.of_voxel * (of_voxel.max() + 1) + of_voxel
        self._patch = np.unique(mixed, return_inverse=True)[1].reshape(-1)
        self._counts = np.bincount(self._patch)
        self._segment = _majority(self._patch, of_voxel, len(self._counts))
        ends = np.sort(self._patch[surface.pairs], axis=1)
        self._pairs, border = np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0, return_counts=True)
        within = self._segment[self._pairs[:, 0]] == self._segment[self._pairs[:, 1]]
        self._weights: NDArray[np.float64] = np.asarray(
            BORDER * border * np.where(within, 1.0, CREASE), np.float64
        )

    # --- pushes -----------------------------------------------------------------------------------------------

    @property
    def segments(self) -> tuple[int, ...]:
        """Labels of the first segmentation, ascending."""
        return tuple(np.unique(self._segment).tolist())

    def poke_at(
        self, segment: int, rng: np.random.Generator, length: float, heights: tuple[float, float] = (0.15, 0.75)
    ) -> Poke | None:
        """A level push against a steep side of a segment where it is now; None if no steep side is seen or known.

        Parameters
        ----------
        segment : int
        rng : numpy.random.Generator
            Draws the place and, within `ASIDE` of the surface's normal, the direction.
        length : float
            Of the push, metres.
        heights : (float, float)
            Shares of the segment's height between which it is touched.
        """
        own = (self._segment == segment)[self._patch] & self._seen[self._patch]
        if self._surface is None or not own.any():
            return None
        places, normals = (each[own] for each in self._now())
        low, high = np.quantile(places[:, 2], [0.02, 0.98])
        level = (places[:, 2] - low) / max(high - low, 1e-6)
        steep = np.abs(normals[:, 2]) < STEEP
        fit = np.flatnonzero(steep & (level >= heights[0]) & (level <= heights[1]))
        if not len(fit):
            return None
        place = int(rng.choice(fit))
        turn = turned_about(np.zeros(3), np.array([0.0, 0.0, rng.uniform(-ASIDE, ASIDE)]), np.zeros(3))
        way = turn[:3, :3] @ (-normals[place] * [1, 1, 0])
        return Poke(places[place], length * way / np.linalg.norm(way))

    def observe(self, poke: Poke, after: LabelledCloud) -> NDArray[np.int64]:
        """Take in the cloud after a push; returns the motion of each patch: 0 at rest, −1 lost."""
        if self._surface is None:
            return np.empty(0, np.int64)
        view = ViewAfter(after)
        places, normals = self._now()
        motions, costs = [STILL], [self._patch_costs(view.costs(places))]
        labels = np.zeros(len(self._counts), np.int64)
        for _ in range(MOST_MOTIONS):
            unexplained = np.where(self._seen, np.stack(costs, 1)[np.arange(len(labels)), labels], 0.0)
            fitted = self._next_motion(view, places, normals, unexplained, poke, motions)
            if fitted is None:
                break
            added = self._patch_costs(view.costs(moved(places, fitted)))
            tried = motion_labels(np.stack([*costs, added], 1) * self._seen[:, None], self._pairs, self._weights)
            if not (tried == len(motions)).any():
                break
            motions.append(fitted)
            costs.append(added)
            labels = tried
        every, seen = np.stack(costs, 1), self._seen.copy()
        labels = self._carried(places, labels, motions, every)
        if (self._seen != seen).any():
            # Something fell or rolled away, perhaps over the others: this push tells nothing.
            labels = np.full(len(labels), -1)
        self._motions.append(labels)
        self._costs.append(every)
        self._touched.append(self._touched_segment(places, poke))
        return labels

    def _now(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where each voxel is now, and its normal, (m, 3) each."""
        assert self._surface is not None
        pose, surface = self._pose[self._patch], self._surface
        places, normals = ((pose[:, :3, :3] @ of[:, :, None])[..., 0] for of in (surface.points, surface.normals))
        return places + pose[:, :3, 3], normals

    def _patch_costs(self, costs: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.bincount(self._patch, costs, len(self._counts)).astype(np.float64)

    def _next_motion(
        self,
        view: ViewAfter,
        places: NDArray,
        normals: NDArray,
        unexplained: NDArray,
        poke: Poke,
        motions: list[Motion],
    ) -> Motion | None:
        """A motion for the segment with most unexplained voxels; None where no motion explains enough of them."""
        found = np.bincount(self._segment, unexplained)
        for segment in np.argsort(-found)[:3]:
            if found[segment] < LEAST_EVIDENCE:
                return None
            own = (self._segment == segment)[self._patch] & self._seen[self._patch]
            spread = np.flatnonzero(own)
            chosen = spread[:: max(1, len(spread) // _SAMPLE)]
            sample, source = places[chosen], view_of(places[chosen], normals[chosen])
            loose = places[own & (unexplained > 0.4 * self._counts)[self._patch]]
            middle = loose.mean(axis=0) if len(loose) else sample.mean(axis=0)
            now = view.costs(sample).sum()
            best, least = None, now * 0.85
            for start in [*motions[1:], *_starts(middle, poke.push)]:
                motion = refined_motion(view.surface, source, start)
                if motion is None:
                    continue
                cost = float(view.costs(moved(sample, motion)).sum())
                gain = self._gain(view, places, own, motion)
                far = largest_step(motion, sample) > FARTHEST * float(np.linalg.norm(poke.push))
                if not far and gain > 0 and (best is None or cost - gain < least):
                    best, least = motion, cost - gain
            if best is not None:
                return best
        return None

    def _gain(self, view: ViewAfter, places: NDArray, own: NDArray, motion: Motion) -> float:
        """Voxels of evidence that a motion explains better than rest, patch by patch."""
        before = np.bincount(self._patch[own], view.costs(places[own]), len(self._counts))
        after = np.bincount(self._patch[own], view.costs(moved(places[own], motion)), len(self._counts))
        gain = float(np.maximum(before - after, 0).sum())
        return gain if gain >= LEAST_EVIDENCE else 0.0

    def _carried(self, places: NDArray, labels: NDArray, motions: list[Motion], costs: NDArray) -> NDArray:
        """Carry the patches along; patches that no motion explains are lost from now on."""
        chosen, labels = labels, labels.copy()
        for number, motion in enumerate(motions):
            rows = labels == number
            if not rows.any():
                continue
            if largest_step(motion, places[rows[self._patch]]) < MOVED:
                labels[rows] = 0
                continue
            self._pose[rows] = motion @ self._pose[rows]
        # A segment whose surface is found too rarely tells nothing now; if even rarer, it cannot be followed.
        size = np.maximum(np.bincount(self._segment, self._counts), 1)
        poor = np.bincount(self._segment, costs[np.arange(len(labels)), chosen]) / size
        self._seen &= (poor <= LOST)[self._segment]
        return np.where(self._seen & (poor <= DOUBTFUL)[self._segment], labels, -1)

    def _touched_segment(self, places: NDArray, poke: Poke) -> int:
        return int(self._segment[self._patch[np.linalg.norm(places - poke.place, axis=1).argmin()]])


def largest_step(motion: Motion, points: NDArray[np.float64]) -> float:
    """Largest way of one of the points (n, 3), metres."""
    return float(np.linalg.norm(moved(points, motion) - points, axis=1).max(initial=0.0))


def turned_about(middle: NDArray[np.float64], turn: NDArray[np.float64], shift: NDArray[np.float64]) -> Motion:
    """A turn by the rotation vector `turn` about a point, and then a shift."""
    motion = np.eye(4)
    motion[:3, :3] = Rotation.from_rotvec(turn).as_matrix()
    motion[:3, 3] = middle - motion[:3, :3] @ middle + shift
    return motion


def _starts(middle: NDArray[np.float64], push: NDArray[np.float64]) -> list[Motion]:
    """Motions at which registrations start: the way of the fingertip and half of it, with turns."""
    return [turned_about(middle, np.array([0, 0, turn]), part * push) for part in (1.0, 0.5) for turn in _TURNS]


def _majority(group: NDArray[np.int64], labels: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """(n,) the most frequent label of each group."""
    values, column = np.unique(labels, return_inverse=True)
    table = np.zeros((n, len(values)), np.int64)
    np.add.at(table, (group, column.reshape(-1)), 1)
    return values[table.argmax(axis=1)]
