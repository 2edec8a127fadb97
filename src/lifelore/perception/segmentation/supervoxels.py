"""Supervoxels: small patches of surface that grow from a lattice of seeds, and where they meet.

After Papon et al. (2013). A patch takes the voxels that are nearest to its seed along the surface, where a step
costs its length and the turn of the normal. So patches end at creases rather than cross them.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.clouds.voxel import box_of, voxels_of
from lifelore.perception.segmentation.surface_voxels import SurfaceVoxels

if TYPE_CHECKING:
    from scipy.sparse import csr_array


class Supervoxels(NamedTuple):
    """Patches of a surface and their borders.

    Parameters
    ----------
    of_voxel : (m,) int64
        Patch of each voxel, from 0.
    counts : (k,) int64
        Number of voxels of each patch.
    middles, normals : (k, 3) float64
    pairs : (e, 2) int64
        Patches that touch, each pair once, the lower number first.
    borders : (e,) int64
        Length of the border of each pair: its number of pairs of neighbouring voxels.
    """

    of_voxel: NDArray[np.int64]
    counts: NDArray[np.int64]
    middles: NDArray[np.float64]
    normals: NDArray[np.float64]
    pairs: NDArray[np.int64]
    borders: NDArray[np.int64]


def step_costs(surface: SurfaceVoxels, spacing: float) -> "csr_array":
    """(m, m) cost of a step between neighbouring voxels: its length in `spacing`, and the turn of the normal."""
    from scipy.sparse import coo_array

    a, b = surface.pairs.T
    length = np.linalg.norm(surface.points[a] - surface.points[b], axis=1)
    turn = 1.0 - np.einsum("ij,ij->i", surface.normals[a], surface.normals[b])
    # A cost of exactly zero would be no edge.
    cost = length / spacing + np.clip(turn, 0.0, 2.0) + 1e-6
    m = len(surface.points)
    return coo_array((np.r_[cost, cost], (np.r_[a, b], np.r_[b, a])), shape=(m, m)).tocsr()


def supervoxels(surface: SurfaceVoxels, costs: "csr_array", spacing: float, start: float = 0.0) -> Supervoxels:
    """Patches that grow from seeds about `spacing` metres apart, on a lattice that begins `start` of it lower.

    `costs` are the `step_costs` of the surface.
    """
    of_voxel = _grown(surface, costs, _seeds(surface, spacing, start))
    counts = np.bincount(of_voxel)
    middles = _sums(of_voxel, surface.points) / counts[:, None]
    normals = _sums(of_voxel, surface.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    a, b = of_voxel[surface.pairs.T]
    numbers = np.minimum(a, b) * len(counts) + np.maximum(a, b)
    numbers, borders = np.unique(numbers[a != b], return_counts=True)
    pairs = np.stack(np.divmod(numbers, len(counts)), axis=1)
    return Supervoxels(of_voxel, counts, middles, normals, pairs, borders)


def _grown(surface: SurfaceVoxels, costs: "csr_array", seeds: NDArray[np.int64]) -> NDArray[np.int64]:
    """(m,) int64: number of each voxel's patch; surfaces without a seed are patches of their own voxels."""
    from scipy.sparse.csgraph import dijkstra

    _, _, source = dijkstra(costs, indices=seeds, min_only=True, return_predecessors=True)
    m = len(surface.points)
    owner = source.astype(np.int64)
    if (owner < 0).any():
        owner = np.where(owner >= 0, owner, m + connected_parts(surface.pairs, m))
    used = np.bincount(owner) > 0
    return (np.cumsum(used) - 1)[owner]


def _seeds(surface: SurfaceVoxels, spacing: float, start: float) -> NDArray[np.int64]:
    """The voxel of each occupied cell of the lattice that is nearest to the mean of the cell's voxels."""
    places = surface.points - (box_of(surface.points)[0] - start * spacing)
    cells = voxels_of(places, spacing)
    away = places - cells.means[cells.inverse]
    away = np.einsum("ij,ij->i", away, away)
    least = np.full(len(cells.first), np.inf)
    np.minimum.at(least, cells.inverse, away)
    nearest = np.flatnonzero(away == least[cells.inverse])
    return nearest[np.unique(cells.inverse[nearest], return_index=True)[1]]


def _sums(group: NDArray[np.int64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 3): sum of the rows of each group."""
    return np.stack([np.bincount(group, values[:, axis]) for axis in range(3)], axis=1).astype(np.float64)
