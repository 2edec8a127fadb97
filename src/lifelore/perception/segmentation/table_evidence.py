"""Evidence for and against each flat patch of a cloud as the table: points that stand on it, hang or float."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.segmentation.outline import over_outline
from lifelore.perception.segmentation.plane import Plane
from lifelore.perception.segmentation.surface_patches import LEAST_PLANE, OrientedVoxels, Patch

LEVEL = 10.0
"""Degrees between a table's normal and a known up direction."""
PARALLEL = np.cos(np.radians(LEVEL))
REACH = 0.6
"""Metres above a table within which objects stand on it."""
FACE_AREA = 0.12
"""Square metres; a smaller patch with as many points below its border is the top of an object."""
HANGING = 0.20
"""Metres above a plane from which a cluster hangs in the air; below, its support may be hidden."""
HIDDEN_FOOT = 0.15
"""Metres between a cluster in the air and what stands below it, within which it hides its own support."""
BELOW_SHARE = 0.3
_SPECK = 4
FRINGE = 2.0
"""Bands of a large patch within which a voxel is its noise, and no evidence for another patch."""
_RISE = 1.5
"""Bands that a cluster must rise above a plane; a lower one may be the plane's own noise."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A patch with one of its two sides as the upper, and the evidence for it, in points of the cloud.

    Parameters
    ----------
    patch : Patch
    plane : Plane
        Of the patch; its normal is upward.
    standing : int
        Points of clusters that stand on it and rise no higher than `REACH`.
    tall : int
        Points of clusters that stand on it and rise higher: a table's legs on the floor.
    hanging : int
        Points of clusters over it that touch nothing and begin at least `HANGING` above it, with nothing under
        them on which they may stand.
    floating : int
        Points of clusters anywhere that touch neither it nor a large patch, and are not low over it: objects on a
        table of glass.
    below : int
        Points under it.
    on_it : int
        Points of the patch.
    """

    patch: Patch
    plane: Plane
    standing: int
    tall: int
    hanging: int
    floating: int
    below: int
    on_it: int

    @property
    def score(self) -> int:
        return self.standing - self.hanging

    @property
    def is_face(self) -> bool:
        """Whether it may be an object's own face: small, with points below its border."""
        return self.patch.area < FACE_AREA and self.below > BELOW_SHARE * self.on_it


@dataclass(frozen=True, eq=False)
class _Surroundings:
    """All voxels beside the large patches.

    Parameters
    ----------
    large : sequence of Patch
    owner : (m,) int64
        Number of the large patch of each voxel; -1 without.
    fringe : (l, m) bool
        Voxels without a large patch that are so near to one that they may be its noise.
    loose : (m,) int64
        Number of the cluster of each voxel that is neither on a large patch nor linked to one; -1 of the others.
    """

    large: Sequence[Patch]
    owner: NDArray[np.int64]
    fringe: NDArray[np.bool_]
    loose: NDArray[np.int64]


def candidates_of(
    voxels: OrientedVoxels, found: Sequence[Patch], large: Sequence[Patch], camera: NDArray[np.float64] | None
) -> list[Candidate]:
    """Both sides of every patch of a table's size, judged; the camera's side first."""
    around = _surroundings(voxels, large)
    made = []
    for patch in found:
        if patch.area < LEAST_PLANE:
            continue
        near_side = camera is None or patch.plane.height(camera) >= 0
        for plane in (patch.plane, patch.plane.flipped()) if near_side else (patch.plane.flipped(), patch.plane):
            made.append(_judged(voxels, patch, plane, around))
    return made


def _surroundings(voxels: OrientedVoxels, large: Sequence[Patch]) -> _Surroundings:
    n = len(voxels.points)
    owner = np.full(n, -1)
    for number, patch in enumerate(large):
        owner[patch.voxels] = number
    fringe = np.zeros((len(large), n), bool)
    for near, patch in zip(fringe, large, strict=True):
        near[:] = (np.abs(patch.plane.height(voxels.points)) <= FRINGE * voxels.bands) & (owner < 0)
        near[near] = patch.covers(voxels.points[near])
    free = np.flatnonzero(owner < 0)
    loose = np.full(n, -1)
    if len(free):
        loose[free] = _clusters(free, voxels.links, n)
        k = int(loose.max()) + 1
        held = _touching(loose, owner >= 0, voxels.links, k) | (np.bincount(loose[free], minlength=k) < _SPECK)
        loose[free] = np.where(held[loose[free]], -1, loose[free])
    return _Surroundings(large, owner, fringe, loose)


def _judged(voxels: OrientedVoxels, patch: Patch, plane: Plane, around: _Surroundings) -> Candidate:
    """The evidence for a patch with this upper side.

    Clusters of voxels over it that touch it stand on it, unless they touch another large patch parallel to it: a
    table's legs. Clusters that touch neither it nor a large patch, and begin `HANGING` above it, hang in the air,
    unless what stands below them may carry them.
    The noise of other large patches is left out.
    """
    owner, n = around.owner, len(voxels.points)
    heights = plane.height(voxels.points)
    foot = np.zeros(n, bool)
    foot[patch.voxels] = True
    others = np.array([other is not patch for other in around.large], bool)
    over = (np.abs(heights) > voxels.bands) & (np.abs(heights) <= 2 * REACH) & (owner < 0) & ~foot
    over &= ~around.fringe[others].any(axis=0)
    over[over] = patch.covers(voxels.points[over])
    below = int(voxels.counts[over & (heights < 0) & (heights > -REACH / 2)].sum())
    # A camera above sees the tops of objects alone: what is low over the patch may stand on it.
    low = (heights > 0) & (heights < HANGING)
    low[low] = patch.covers(voxels.points[low])
    near = foot | low | (np.abs(heights) <= voxels.bands)
    on_it = int(voxels.counts[patch.voxels].sum())
    above = np.flatnonzero(over & (heights > 0))
    if len(above) == 0:
        return Candidate(patch, plane, 0, 0, 0, _floating(voxels, around, near), below, on_it)
    cluster = np.full(n, -1)
    cluster[above] = _clusters(above, voxels.links, n)
    k = int(cluster.max()) + 1
    size = np.bincount(cluster[above], minlength=k)
    points = np.bincount(cluster[above], voxels.counts[above], minlength=k)
    top, bottom, rise = np.full(k, -np.inf), np.full(k, np.inf), np.zeros(k)
    np.maximum.at(top, cluster[above], heights[above])
    np.minimum.at(bottom, cluster[above], heights[above])
    np.maximum.at(rise, cluster[above], heights[above] / voxels.bands[above])
    parallel = np.array([abs(other.plane.normal @ plane.normal) >= PARALLEL for other in around.large], bool)
    other_level = (owner >= 0) & np.append(parallel, False)[owner] & ~foot
    on_foot, on_level, on_large = (
        _touching(cluster, mask, voxels.links, k) for mask in (foot, other_level, (owner >= 0) & ~foot)
    )
    of_size = (size >= _SPECK) & (rise > _RISE)
    standing = on_foot & ~on_level & of_size & (top <= REACH)
    tall = on_foot & of_size & (top > REACH)
    carried = np.zeros(k, bool)
    hanging = ~on_foot & ~on_large & (size >= _SPECK) & (bottom >= HANGING)
    flat = voxels.points @ patch.flat.T
    for number in np.flatnonzero(hanging):
        pillars = standing & (top >= bottom[number] - HIDDEN_FOOT)
        if over_outline(flat[above[pillars[cluster[above]]]], flat[cluster == number]).any():
            hanging[number], carried[number] = False, True
    near[above] |= carried[cluster[above]]
    floating = _floating(voxels, around, near)
    standing |= carried
    stand, rise_high, hang = (int(points[which].sum()) for which in (standing, tall, hanging))
    return Candidate(patch, plane, stand, rise_high, hang, floating, below, on_it)


def _floating(voxels: OrientedVoxels, around: _Surroundings, near: NDArray[np.bool_]) -> int:
    """Points of the loose clusters without a voxel in `near`."""
    loose = around.loose >= 0
    held = np.isin(around.loose, np.unique(around.loose[loose & near]))
    return int(voxels.counts[loose & ~held].sum())


def _clusters(members: NDArray[np.int64], links: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Number of the connected cluster of each of `members`, which are some of n voxels."""
    number = np.full(n, -1)
    number[members] = np.arange(len(members))
    pairs = number[links]
    return connected_parts(pairs[(pairs >= 0).all(axis=1)], len(members))


def _touching(
    cluster: NDArray[np.int64], mask: NDArray[np.bool_], links: NDArray[np.int64], k: int
) -> NDArray[np.bool_]:
    """(k,) bool: clusters of which a voxel is linked to a voxel of `mask`."""
    first, second = links.T
    met = np.concatenate([cluster[first[mask[second]]], cluster[second[mask[first]]]])
    return np.bincount(met[met >= 0], minlength=k) > 0
