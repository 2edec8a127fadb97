"""Segmentation by curvature: the surface is cut wherever it bends sharply, outwards or inwards.

The thesis (§2.3.3) names discontinuities in curvature as one way to be rid of the assumption of colours. A crease
between two objects is such a discontinuity, and so is the edge of a box: each face becomes an object of its own.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import UNLABELLED
from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.segmentation.cut_confidence import labels_by_size
from lifelore.perception.segmentation.surface_voxels import SurfaceVoxels, surface_voxels

VOXEL = 0.005
"""Metres."""
SHARP = 45.0
"""Curvature in 1/m from which a place is an edge: a radius of 22 mm. Less cuts cups and bottles into strips, more
misses creases; chosen on simulated scenes of the shapes for training and on the real scenes."""
_REACH = 4.0
"""Voxel sizes within which an edge joins the nearest smooth region: the width over which normals are smoothed."""
_MOST_VOXELS = 100_000


def smooth_surfaces(
    points: NDArray[np.float64], camera: NDArray[np.float64] | None, min_area: float
) -> NDArray[np.int64]:
    """(n,) int64: 2 the largest connected surface without an edge, 3 the next, …, 0 noise.

    Parameters
    ----------
    points, camera
        As of `convex_objects`.
    min_area : float
        Square metres of smooth surface below which a region is noise.
    """
    from scipy.spatial import KDTree

    if len(points) == 0:
        return np.empty(0, np.int64)
    surface = surface_voxels(points, camera, VOXEL, _MOST_VOXELS)
    m = len(surface.points)
    smooth = curvature(surface) < SHARP
    region = connected_parts(surface.pairs[smooth[surface.pairs].all(axis=1)], m)
    label = labels_by_size(np.bincount(region[smooth], minlength=m) * surface.size**2, min_area)
    labels = np.where(smooth, label[region], UNLABELLED)
    rest, known = np.flatnonzero(labels == UNLABELLED), np.flatnonzero(labels != UNLABELLED)
    if len(rest) and len(known):
        away, nearest = KDTree(surface.points[known]).query(surface.points[rest])
        labels[rest] = np.where(away <= _REACH * surface.size, labels[known[nearest]], UNLABELLED)
    return labels[surface.inverse]


def curvature(surface: SurfaceVoxels) -> NDArray[np.float64]:
    """(m,) 1/m: mean turn of the normal for each metre from a voxel to its neighbours; 0 without neighbours."""
    a, b = surface.pairs.T
    cosine = np.einsum("ij,ij->i", surface.normals[a], surface.normals[b])
    apart = np.linalg.norm(surface.points[a] - surface.points[b], axis=1)
    bend = np.arccos(np.clip(cosine, -1.0, 1.0)) / np.maximum(apart, 1e-9)
    m = len(surface.points)
    ends, twice = np.concatenate([a, b]), np.concatenate([bend, bend])
    return np.bincount(ends, twice, minlength=m) / np.maximum(np.bincount(ends, minlength=m), 1)
