"""Flat patches of a cloud: planes found in turn among oriented voxels, each cut into connected pieces."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.surface_normals import surface_normals
from lifelore.perception.clouds.voxel import voxels_of
from lifelore.perception.segmentation.outline import convex_corners, over_outline
from lifelore.perception.segmentation.plane import Plane
from lifelore.perception.segmentation.range_noise import band

COARSEST = 0.02
"""Metres: side of a voxel; a smaller scene gets smaller voxels, a fiftieth of its width."""
LEAST_PLANE = 0.03
"""Square metres of a plane, all its pieces together; a smaller one is no table, and is not looked for."""
LEAST_AREA = 0.004
"""Square metres; a smaller piece of a plane is left out."""
_MOST_PLANES = 16
_HYPOTHESES = 200
_SAMPLE = 3000
_ALIKE = np.cos(np.radians(30.0))
"""A voxel is part of a plane only if its own normal is within 30° of the plane's."""
_MOST_VOXELS = 25_000


@dataclass(frozen=True, eq=False)
class OrientedVoxels:
    """A cloud as voxels with normals.

    Parameters
    ----------
    points, normals : (m, 3) float64
        Mean point, and unit normal of its neighbourhood, of either sign.
    counts : (m,) int64
        Points of the cloud in each voxel.
    bands : (m,) float64
        Half width of a plane's band there, metres.
    free : (m,) bool
        Whether a plane may be made of it.
    inverse : (n,) int64
        The voxel of each point of the cloud.
    size : float
        Side of a voxel, metres.
    links : (k, 2) int64
        Pairs of voxels nearer than two and a half sides.
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    counts: NDArray[np.int64]
    bands: NDArray[np.float64]
    free: NDArray[np.bool_]
    inverse: NDArray[np.int64]
    size: float
    links: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Patch:
    """A connected piece of a plane.

    Parameters
    ----------
    plane : Plane
        Its normal has either sign.
    voxels : (k,) int64
        Voxels on it.
    flat : (2, 3) float64
        Two unit vectors along the plane.
    area : float
        Square metres of occupied voxels.
    corners : (k, 2) float64
        The voxels in the directions of `flat`; their convex hull is the outline.
    """

    plane: Plane
    voxels: NDArray[np.int64]
    flat: NDArray[np.float64]
    area: float
    corners: NDArray[np.float64]

    def covers(self, points: NDArray[np.float64], margin: float = 0.0) -> NDArray[np.bool_]:
        """(n,) bool: whether points (n, 3) lie over or under its convex outline, grown by `margin` metres."""
        return over_outline(points @ np.ascontiguousarray(self.flat.T), self._outline, margin)

    @cached_property
    def _outline(self) -> NDArray[np.float64]:
        """(k, 2) corners of the convex hull; all voxels where they span no area."""
        hull = convex_corners(self.corners)
        return self.corners if hull is None else hull


def oriented_voxels(
    points: NDArray[np.float64], camera: NDArray[np.float64] | None, free: NDArray[np.bool_]
) -> OrientedVoxels:
    """The voxels of a cloud; those with `free` (n,) and other points are separate."""
    from scipy.spatial import KDTree

    low, high = np.percentile(points[:: max(1, len(points) // 20_000)], (2, 98), axis=0)
    size = float(np.clip(np.max(high - low) / 50, 1e-4, COARSEST))
    which = free.astype(np.int64)
    thin = voxels_of(points, size, which)
    while len(thin.counts) > _MOST_VOXELS:
        size *= 1.5
        thin = voxels_of(points, size, which)
    places = thin.means
    links = KDTree(places).query_pairs(2.5 * size, output_type="ndarray").astype(np.int64).reshape(-1, 2)
    normals = surface_normals(places, links)
    return OrientedVoxels(
        places, normals, thin.counts, band(places, camera), free[thin.first], thin.inverse, size, links
    )


def patches(voxels: OrientedVoxels, rng: np.random.Generator) -> list[Patch]:
    """The connected flat pieces of a cloud, those of the largest plane first; `rng` draws the hypotheses."""
    left = voxels.free.copy()
    found: list[Patch] = []
    for _ in range(_MOST_PLANES):
        places = np.flatnonzero(left)
        if len(places) * voxels.size**2 < LEAST_PLANE or len(places) < 12:
            break
        plane = _best_plane(voxels, places, rng)
        near = places[np.abs(plane.height(voxels.points[places])) <= voxels.bands[places]]
        on_it = near[np.abs(voxels.normals[near] @ plane.normal) >= _ALIKE]
        if len(on_it) * voxels.size**2 < LEAST_PLANE or len(on_it) < 12:
            break
        left[near] = False
        found += _pieces(voxels, plane, on_it)
    return found


def united(pieces: Sequence[Patch]) -> Patch:
    """One patch of pieces of the same plane, at least one."""
    first = pieces[0]
    return Patch(
        first.plane,
        np.concatenate([piece.voxels for piece in pieces]),
        first.flat,
        sum(piece.area for piece in pieces),
        np.concatenate([piece.corners for piece in pieces]),
    )


def _best_plane(voxels: OrientedVoxels, places: NDArray[np.int64], rng: np.random.Generator) -> Plane:
    """The plane with most agreeing voxels among `places`, from their own normals, refined."""
    sample = places if len(places) <= _SAMPLE else places[rng.choice(len(places), _SAMPLE, replace=False)]
    starts = sample[rng.integers(0, len(sample), _HYPOTHESES)]
    normals = voxels.normals[starts]
    offsets = -np.einsum("ij,ij->i", normals, voxels.points[starts])
    some = _Oriented(voxels.points[sample], voxels.normals[sample], voxels.bands[sample])
    votes = _votes(some, normals, offsets)
    best, best_votes = None, -1
    for start in np.argsort(-votes, kind="stable")[:3]:
        plane = _fitted(some, Plane(normals[start], float(offsets[start])), 3)
        agreed = int(_agreeing(some, plane).sum())
        if agreed > best_votes:
            best, best_votes = plane, agreed
    assert best is not None
    return _fitted(_Oriented(voxels.points[places], voxels.normals[places], voxels.bands[places]), best, 1)


class _Oriented(NamedTuple):
    """Some voxels: points and normals (k, 3), half widths of their bands (k,)."""

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    bands: NDArray[np.float64]


def _votes(some: _Oriented, normals: NDArray[np.float64], offsets: NDArray[np.float64]) -> NDArray[np.int64]:
    """(h,) number of voxels that agree with each plane of `normals` (h, 3) and `offsets` (h,)."""
    # In place: a new array of this size takes longer than its numbers.
    away = some.points @ normals.T
    away += offsets
    near = np.abs(away, out=away) <= some.bands[:, None]
    alike = np.matmul(some.normals, normals.T, out=away)
    near &= np.abs(alike, out=alike) >= _ALIKE
    return np.count_nonzero(near, axis=0)


def _agreeing(some: _Oriented, plane: Plane) -> NDArray[np.bool_]:
    return (np.abs(plane.height(some.points)) <= some.bands) & (np.abs(some.normals @ plane.normal) >= _ALIKE)


def _fitted(some: _Oriented, plane: Plane, rounds: int) -> Plane:
    """The plane of least squares, each voxel weighed by its noise, of the voxels that agree with the plane before.

    It starts from `plane`, and stops where the same voxels agree again.
    """
    before = np.empty(0, bool)
    for _ in range(rounds):
        agree = _agreeing(some, plane)
        if np.array_equal(agree, before) or np.count_nonzero(agree) < 3:
            break
        plane, before = plane_of(some.points[agree], some.bands[agree] ** -2, plane), agree
    return plane


def plane_of(points: NDArray[np.float64], weights: NDArray[np.float64], like: Plane) -> Plane:
    """The plane of weighted least squares through points (n, 3), its normal on the side of that of `like`."""
    centre = weights @ points / weights.sum()
    away = points - centre
    normal = np.linalg.eigh((away * weights[:, None]).T @ away)[1][:, 0]
    if normal @ like.normal < 0:
        normal = -normal
    return Plane(normal, float(-normal @ centre))


def _pieces(voxels: OrientedVoxels, plane: Plane, on_it: NDArray[np.int64]) -> list[Patch]:
    """Connected pieces, largest first; gaps of two cells, as an object's shadow leaves, do not part them."""
    from scipy import ndimage

    flat = np.linalg.svd(plane.normal[None])[2][1:]
    spread = voxels.points[on_it] @ flat.T
    cell = 2.5 * voxels.size
    cells = np.floor((spread - spread.min(axis=0)) / cell).astype(np.int64) + 2
    grid = np.zeros(cells.max(axis=0) + 3, bool)
    grid[tuple(cells.T)] = True
    numbered = np.empty(grid.shape, np.int32)
    ndimage.label(ndimage.binary_dilation(grid), np.ones((3, 3)), output=numbered)
    piece = numbered[tuple(cells.T)]
    parts = [np.flatnonzero(piece == number) for number in range(1, int(piece.max()) + 1)]
    fine = np.floor(spread / voxels.size).astype(np.int64) @ np.array([2**31, 1])
    made = []
    for part in sorted(parts, key=len, reverse=True):
        area = len(np.unique(fine[part])) * voxels.size**2
        if area >= LEAST_AREA and len(part) >= 6:
            made.append(Patch(plane, on_it[part], flat, area, spread[part]))
    return made
