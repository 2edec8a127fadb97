"""The table's plane of a cloud without a labelled table: flat patches judged by evidence, not by size.

A table is level where up is known, objects stand on it, few points hang over it unsupported or float elsewhere,
and it is no face of an object. A wall, a floor under a table and an object's own side fail one of these tests.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.perception.segmentation.camera_doubt import is_camera_frame
from lifelore.perception.segmentation.plane import Plane
from lifelore.perception.segmentation.surface_patches import (
    OrientedVoxels,
    Patch,
    oriented_voxels,
    patches,
    plane_of,
    united,
)
from lifelore.perception.segmentation.table_evidence import BELOW_SHARE, PARALLEL, Candidate, candidates_of

BACKGROUND_AREA = 0.09
"""Square metres; a larger flat patch is furniture or a wall, not an object's face."""
_BARE_SHARE = 0.25
_NOISE_SHARE = 0.01
_INSIDE = 0.7
_PARTED = 0.5
"""Metres between pieces of one table; an object and its shadow part it. More takes other surfaces for it."""
_REFINED = 10_000
"""Points that the plane is fitted to; more costs time, and moves it by less than a tenth of a millimetre."""
_UNLIKELY = 0.25
_FLOATING = 5
"""Times the points of standing objects; where more float, they stand on a table that was not seen."""
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
        Its visible surface: all pieces of the plane, which objects and their shadows part.
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
    candidates = candidates_of(voxels, found, large, camera)
    chosen = _chosen(voxels, candidates, camera, up)
    if chosen is None:
        tilted = None if up is None else _chosen(voxels, candidates, camera, None)
        return Search(None, tilted.plane.normal if tilted is not None and tilted.standing else None)
    pieces = _pieces_near(chosen.patch, found)
    table = _refined(points, camera, voxels, chosen)
    others = tuple(patch for patch in large if patch.plane is not chosen.patch.plane)
    return Search(Table(table, united(pieces), others, chosen.standing))


def _pieces_near(chosen: Patch, found: Sequence[Patch]) -> list[Patch]:
    """The chosen piece, and the others of its plane that are at most `_PARTED` from it or from such a piece."""
    from scipy.spatial import KDTree

    near, far = [chosen], [p for p in found if p.plane is chosen.plane and p is not chosen]
    for piece in near:
        tree = KDTree(piece.corners)
        met = [p for p in far if tree.query(p.corners, distance_upper_bound=_PARTED)[0].min() <= _PARTED]
        near += met
        far = [p for p in far if p not in met]
    return near


def _chosen(
    voxels: OrientedVoxels,
    candidates: Sequence[Candidate],
    camera: NDArray[np.float64] | None,
    up: NDArray[np.float64] | None,
) -> Candidate | None:
    """The likeliest table; None where no candidate passes the tests."""
    if up is not None:
        candidates = [c for c in candidates if c.plane.normal @ up >= PARALLEL]
    total = int(voxels.counts.sum())
    likely = {id(c): up is not None or _is_likely_up(c.plane.normal, voxels, camera) for c in candidates}
    carrying = [
        c
        for c in candidates
        if c.score > _NOISE_SHARE * c.on_it
        and c.floating + c.tall <= _FLOATING * c.standing
        and not c.is_face
        and (likely[id(c)] or c.on_it >= _BARE_SHARE * total)
    ]
    if carrying:
        return max(
            carrying, key=lambda c: _weight(c, carrying, voxels, likely[id(c)]) * np.sqrt(c.score * c.on_it)
        )
    bare = [
        c
        for c in candidates
        if c.below <= BELOW_SHARE * c.on_it
        and max(c.hanging, c.floating, c.tall) <= _NOISE_SHARE * c.on_it
        and (up is not None or c.on_it >= _BARE_SHARE * total)
        and likely[id(c)]
    ]
    return max(bare, key=lambda c: c.on_it, default=None)


def _weight(candidate: Candidate, others: Sequence[Candidate], voxels: OrientedVoxels, likely: bool) -> float:
    """1, or less for a floor below another candidate and for an unlikely up direction."""
    weight = 1.0 if likely else _UNLIKELY
    for other in others:
        places = voxels.points[other.patch.voxels]
        is_above = (
            candidate.plane.normal @ other.plane.normal >= PARALLEL
            and np.median(candidate.plane.height(places)) >= _FLOOR
        )
        if is_above and np.mean(candidate.patch.covers(places)) >= _INSIDE:
            return weight * _UNLIKELY
    return weight


def _is_likely_up(normal: NDArray[np.float64], voxels: OrientedVoxels, camera: NDArray[np.float64] | None) -> bool:
    """Whether a table can have this normal, if the frame is a camera's (x right, y down, z forward).

    A camera looks at a table from above, and rolls little about its axis. Any other frame allows every normal.
    """
    if camera is None or np.abs(camera).max() > 1e-6 or not is_camera_frame(voxels.points):
        return True
    return bool(abs(normal[0]) <= 0.5 and normal[1] <= 0.1 and normal[2] <= 0.1)


def _refined(
    points: NDArray[np.float64],
    camera: NDArray[np.float64] | None,
    voxels: OrientedVoxels,
    chosen: Candidate,
) -> Plane:
    """The plane through points of the patch's voxels, each weighed by its noise."""
    member = np.zeros(len(voxels.points), bool)
    member[chosen.patch.voxels] = True
    near = np.flatnonzero(member[voxels.inverse])
    near = near[:: max(1, len(near) // _REFINED)]
    places, bands = points[near], voxels.bands[voxels.inverse[near]]
    plane = chosen.plane
    for _ in range(3):
        keep = np.abs(plane.height(places)) <= bands
        if np.count_nonzero(keep) < 3:
            break
        plane = plane_of(places[keep], bands[keep] ** -2, plane)
    return plane


def no_table(reason: str = "") -> InputError:
    """The error of a cloud in which no table is found, with `reason` in front of what to do."""
    return InputError(
        f"no table was found in the cloud{reason}; pass the upward direction (--up X,Y,Z), crop the cloud to the"
        " table (--roi, --max-range), or label the table"
    )
