"""Voxels of a visible surface with normals towards the camera, and the pairs of voxels that are neighbours."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.clouds.surface_normals import surface_normals
from lifelore.perception.clouds.voxel import voxels_of

LINK = 1.9
"""Voxel sizes: greatest distance of neighbours. A diagonal step of the grid is 1.7 long."""
_SUPPORT = 2.3
"""Voxel sizes: radius of the voxels that a normal is fitted to, some 16. Less is noisier, more rounds off
creases."""
DENSE = 1.5
"""Least mean number of points in a voxel; below, a surface has holes between its voxels, and they grow."""
COARSER, COARSEST = 1.25, 3.0
"""Step and usual limit of that growth, in sizes asked for."""
_LEVEL = 0.5
"""Without a camera, a normal steeper than this points up; the others point away from the middle of their
surface."""


@dataclass(frozen=True, eq=False)
class SurfaceVoxels:
    """A surface in cells of one size.

    Parameters
    ----------
    points, normals : (m, 3) float64
        Means of the voxels' points; unit vectors towards the camera.
    pairs : (p, 2) int64
        Neighbours, each pair once.
    inverse : (n,) int64
        Voxel of each point of the cloud.
    size : float
        Length of a voxel, metres.
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    pairs: NDArray[np.int64]
    inverse: NDArray[np.int64]
    size: float


def surface_voxels(
    points: NDArray[np.float64],
    camera: NDArray[np.float64] | None,
    size: float,
    most: int,
    sparse: float | None = None,
) -> SurfaceVoxels:
    """The voxels of points (n, 3), n ≥ 1; `size` grows up to `sparse` until they are dense, and until they are
    at most `most`.

    Without a `camera`, level surfaces face upwards and the others away from the middle of their connected surface.
    """
    from scipy.spatial import KDTree

    thin, sparse = voxels_of(points, size), COARSEST * size if sparse is None else sparse
    while len(points) < DENSE * len(thin.counts) and COARSER * size <= sparse:
        size *= COARSER
        thin = voxels_of(points, size)
    while len(thin.counts) > most:
        size *= 2
        thin = voxels_of(points, size)
    middles = thin.means
    around = KDTree(middles).query_pairs(_SUPPORT * size, output_type="ndarray").astype(np.int64).reshape(-1, 2)
    normals = surface_normals(middles, around)
    apart = middles[around[:, 0]] - middles[around[:, 1]]
    pairs = around[np.einsum("ij,ij->i", apart, apart) <= (LINK * size) ** 2]
    outward = middles - _inside(middles, pairs) if camera is None else camera - middles
    away = np.einsum("ij,ij->i", normals, outward) < 0
    if camera is None:
        steep = np.abs(normals[:, 2]) > _LEVEL
        away = np.where(steep, normals[:, 2] < 0, away)
    return SurfaceVoxels(middles, np.where(away[:, None], -normals, normals), pairs, thin.inverse, size)


def _inside(points: NDArray[np.float64], pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """(m, 3): middle of the connected surface of each voxel, at the voxel's height."""
    part = connected_parts(pairs, len(points))
    counts = np.bincount(part)
    middle = np.stack([np.bincount(part, points[:, axis]) / counts for axis in (0, 1)], axis=1)[part]
    return np.column_stack([middle, points[:, 2]])
