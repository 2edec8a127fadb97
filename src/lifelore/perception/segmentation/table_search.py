"""The table's plane of a cloud without a labelled table: flat patches judged by evidence, not by size.

A table is level where up is known, objects stand on it, few points hang over it unsupported, and it is no face of
an object. A wall, a floor under a table and an object's own side fail one of these tests.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.perception.segmentation.plane import Plane
from lifelore.perception.segmentation.surface_patches import (
    OrientedVoxels,
    Patch,
    oriented_voxels,
    patches,
    plane_of,
)

LEVEL = 10.0
"""Degrees between a table's normal and a known up direction."""
REACH = 0.6
"""Metres above a table within which objects stand on it."""
BACKGROUND_AREA = 0.09
"""Square metres; a larger flat patch is furniture or a wall, not an object's face."""
FACE_AREA = 0.12
"""Square metres; a smaller patch with as many points below its border is the top of an object."""
HANGING = 0.20
"""Metres above a plane from which a cluster hangs in the air; below, its support may be hidden."""
LEAST_TABLE = 0.03
"""Square metres; a smaller patch is no table."""
_BELOW_SHARE = 0.3
_BARE_SHARE = 0.25
_NOISE_SHARE, _SURE_SHARE = 0.01, 0.05
_SPECK = 4
_PARALLEL = np.cos(np.radians(LEVEL))
_INSIDE = 0.7
_UNLIKELY = 0.25
_FLOOR = 0.30
"""Metres between a table and a floor below it."""


@dataclass(frozen=True, eq=False)
class Table:
    """The table of a scene.

    Parameters
    ----------
    plane : Plane
        In the frame of the cloud; the normal is upward.
    patch : Patch
        Its visible surface.
    background : tuple of Patch
        Other patches of at least `BACKGROUND_AREA`.
    standing : int
        Points of objects that stand on it.
    """

    plane: Plane
    patch: Patch
    background: tuple[Patch, ...]
    standing: int


@dataclass(frozen=True, eq=False)
class Search:
    """What a search for the table found.

    Parameters
    ----------
    table : Table, optional
    tilted : (3,) float64, optional
        Where no level table was found under a known up: the normal of the tilted plane that objects stand on.
    """

    table: Table | None
    tilted: NDArray[np.float64] | None = None


@dataclass(frozen=True, eq=False)
class _Candidate:
    """A patch with one of its two sides as the upper, and the evidence for it, in points of the cloud."""

    patch: Patch
    plane: Plane
    standing: int
    hanging: int
    below: int
    on_it: int

    @property
    def score(self) -> int:
        return self.standing - self.hanging

    @property
    def is_face(self) -> bool:
        """Whether it may be an object's own face: small, with points below its border."""
        return self.patch.area < FACE_AREA and self.below > _BELOW_SHARE * self.on_it


def find_table(
    points: NDArray[np.float64],
    camera: NDArray[np.float64] | None = None,
    up: NDArray[np.float64] | None = None,
    free: NDArray[np.bool_] | None = None,
) -> Search:
    """Search a cloud for its table.

    Parameters
    ----------
    points : (n, 3) float64
        Metres, finite.
    camera : (3,) float64, optional
        Where the cloud was seen from; decides the upper side of a plane with nothing on it, and the noise.
    up : (3,) unit vector, optional
        Known upward direction.
    free : (n,) bool, optional
        Points that may belong to the table; default all.
    """
    free = np.ones(len(points), bool) if free is None else free
    if np.count_nonzero(free) < 12:
        return Search(None)
    voxels = oriented_voxels(points, camera, free)
    found = patches(voxels, stream(0, "perception", "table search"))
    large = tuple(patch for patch in found if patch.area >= BACKGROUND_AREA)
    candidates = _candidates(voxels, found, large, camera)
    chosen = _chosen(voxels, candidates, camera, up)
    if chosen is None:
        tilted = None if up is None else _chosen(voxels, candidates, camera, None)
        return Search(None, tilted.plane.normal if tilted is not None and tilted.standing else None)
    table = _refined(points, camera, voxels, chosen)
    others = tuple(patch for patch in large if patch is not chosen.patch)
    return Search(Table(table, chosen.patch, others, chosen.standing))


def _candidates(
    voxels: OrientedVoxels, found: Sequence[Patch], large: Sequence[Patch], camera: NDArray[np.float64] | None
) -> list[_Candidate]:
    """Both sides of every patch of a table's size, judged; the camera's side first."""
    owner = np.full(len(voxels.points), -1)
    for number, patch in enumerate(large):
        owner[patch.voxels] = number
    made = []
    for patch in found:
        if patch.area < LEAST_TABLE:
            continue
        parallel = np.array([abs(other.plane.normal @ patch.plane.normal) >= _PARALLEL for other in large], bool)
        near_side = camera is None or patch.plane.height(camera) >= 0
        for plane in (patch.plane, patch.plane.flipped()) if near_side else (patch.plane.flipped(), patch.plane):
            made.append(_judged(voxels, patch, plane, owner, parallel))
    return made


def _judged(
    voxels: OrientedVoxels, patch: Patch, plane: Plane, owner: NDArray[np.int64], parallel: NDArray[np.bool_]
) -> _Candidate:
    """The evidence for a patch with this upper side.

    Clusters of voxels over it that touch it stand on it, unless they touch another large patch parallel to it: a
    table's legs. Clusters that touch neither it nor a large patch, and begin `HANGING` above it, hang in the air.
    """
    heights = plane.height(voxels.points)
    over = (np.abs(heights) > voxels.bands) & (np.abs(heights) <= 2 * REACH) & (owner < 0)
    over[patch.voxels] = False
    over[over] = patch.covers(voxels.points[over])
    below = int(voxels.counts[over & (heights < 0) & (heights > -REACH / 2)].sum())
    above = np.flatnonzero(over & (heights > 0))
    on_it = int(voxels.counts[patch.voxels].sum())
    if len(above) == 0:
        return _Candidate(patch, plane, 0, 0, below, on_it)
    cluster = np.full(len(voxels.points), -1)
    cluster[above] = _clusters(above, voxels.links, len(voxels.points))
    k = int(cluster.max()) + 1
    size = np.bincount(cluster[above], minlength=k)
    points = np.bincount(cluster[above], voxels.counts[above], minlength=k)
    top, bottom = np.full(k, -np.inf), np.full(k, np.inf)
    np.maximum.at(top, cluster[above], heights[above])
    np.minimum.at(bottom, cluster[above], heights[above])
    foot = np.zeros(len(voxels.points), bool)
    foot[patch.voxels] = True
    other_level = (owner >= 0) & np.append(parallel, False)[owner] & ~foot
    touches = {
        name: _touching(cluster, mask, voxels.links, k)
        for name, mask in (("foot", foot), ("level", other_level), ("large", (owner >= 0) & ~foot))
    }
    standing = touches["foot"] & ~touches["level"] & (size >= _SPECK) & (top <= REACH)
    hanging = ~touches["foot"] & ~touches["large"] & (size >= _SPECK) & (bottom >= HANGING)
    return _Candidate(patch, plane, int(points[standing].sum()), int(points[hanging].sum()), below, on_it)


def _clusters(members: NDArray[np.int64], links: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Number of the connected cluster of each of `members`, which are some of n voxels."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    number = np.full(n, -1)
    number[members] = np.arange(len(members))
    pairs = number[links]
    pairs = pairs[(pairs >= 0).all(axis=1)]
    graph = coo_array((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(members),) * 2)
    return connected_components(graph, directed=False)[1].astype(np.int64)


def _touching(
    cluster: NDArray[np.int64], mask: NDArray[np.bool_], links: NDArray[np.int64], k: int
) -> NDArray[np.bool_]:
    """(k,) bool: clusters of which a voxel is linked to a voxel of `mask`."""
    first, second = links.T
    met = np.concatenate([cluster[first[mask[second]]], cluster[second[mask[first]]]])
    return np.bincount(met[met >= 0], minlength=k) > 0


def _chosen(
    voxels: OrientedVoxels,
    candidates: Sequence[_Candidate],
    camera: NDArray[np.float64] | None,
    up: NDArray[np.float64] | None,
) -> _Candidate | None:
    """The likeliest table; None where no candidate passes the tests."""
    if up is not None:
        candidates = [c for c in candidates if c.plane.normal @ up >= _PARALLEL]
    total = int(voxels.counts.sum())
    likely = {id(c): up is not None or _is_likely_up(c.plane.normal, voxels, camera) for c in candidates}
    carrying = [
        c
        for c in candidates
        if c.score > _NOISE_SHARE * c.on_it and not c.is_face and (likely[id(c)] or c.on_it >= _BARE_SHARE * total)
    ]
    if carrying:
        return max(
            carrying, key=lambda c: _weight(c, carrying, voxels, likely[id(c)]) * np.sqrt(c.score * c.on_it)
        )
    bare = [
        c
        for c in candidates
        if c.below <= _BELOW_SHARE * c.on_it
        and c.hanging <= _NOISE_SHARE * c.on_it
        and (up is not None or c.on_it >= _BARE_SHARE * total)
        and likely[id(c)]
    ]
    return max(bare, key=lambda c: c.on_it, default=None)


def _weight(candidate: _Candidate, others: Sequence[_Candidate], voxels: OrientedVoxels, likely: bool) -> float:
    """1, or less for a floor below another candidate and for an unlikely up direction."""
    weight = 1.0 if likely else _UNLIKELY
    for other in others:
        places = voxels.points[other.patch.voxels]
        is_above = (
            candidate.plane.normal @ other.plane.normal >= _PARALLEL
            and np.median(candidate.plane.height(places)) >= _FLOOR
        )
        if is_above and np.mean(candidate.patch.covers(places)) >= _INSIDE:
            return weight * _UNLIKELY
    return weight


def _is_likely_up(normal: NDArray[np.float64], voxels: OrientedVoxels, camera: NDArray[np.float64] | None) -> bool:
    """Whether a table can have this normal, if the frame is a camera's (x right, y down, z forward).

    A camera looks at a table from above, and rolls little about its axis. Any other frame allows every normal.
    """
    if camera is None or np.abs(camera).max() > 1e-6:
        return True
    x, y, z = voxels.points.T
    if np.mean((z > 0) & (np.abs(x) < 1.2 * z) & (np.abs(y) < 1.2 * z)) < 0.99:
        return True
    return bool(abs(normal[0]) <= 0.5 and normal[1] <= 0.1 and normal[2] <= 0.1)


def _refined(
    points: NDArray[np.float64],
    camera: NDArray[np.float64] | None,
    voxels: OrientedVoxels,
    chosen: _Candidate,
) -> Plane:
    """The plane through all points of the patch's voxels, each weighed by its noise."""
    member = np.zeros(len(voxels.points), bool)
    member[chosen.patch.voxels] = True
    near = np.flatnonzero(member[voxels.inverse])
    bands = voxels.bands[voxels.inverse[near]]
    plane = chosen.plane
    for _ in range(3):
        keep = np.abs(plane.height(points[near])) <= bands
        if np.count_nonzero(keep) < 3:
            break
        plane = plane_of(points[near[keep]], bands[keep] ** -2, plane)
    return plane


def no_table(reason: str = "") -> InputError:
    """The error of a cloud in which no table is found, with `reason` in front of what to do."""
    return InputError(
        f"no table was found in the cloud{reason}; give up as a vector or 'z' (--up X,Y,Z), crop the cloud to the"
        " table (--roi, --max-range), or label the table"
    )
