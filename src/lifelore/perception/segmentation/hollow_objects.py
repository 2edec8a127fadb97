"""Inside and outside of hollow objects: bowls, mugs and pots of which the camera sees both sides at the rim.

The near wall hides where the inside meets it, so the two are separate surfaces. They belong together if both end
at one height, without a level top, on one circle, and one faces the middle while the other faces away from it.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.segmentation.supervoxels import Supervoxels
from lifelore.perception.segmentation.surface_voxels import SurfaceVoxels

_RIM = 0.012
"""Metres between the heights at which the two sides end; noise of a depth camera at the rim."""
_TOUCH = 0.060
"""Metres between the two sides where they are nearest, at the ends of the rim, which a camera often misses."""
_UPRIGHT, _LEVEL = 0.80, 0.85
"""Vertical part of a normal: below the first it faces sideways, above the second the surface is level."""
_HIGH = 0.020
"""Metres below the top that count as the rim."""
_FACING, _MOST_LEVEL = 0.85, 0.3
"""Least share of the sideways surface that faces the middle (or away from it); largest share of the rim that is
level."""
_ROUND = 0.12
"""Largest distance of the rim from a circle, in radii: bowls, mugs and pots have at most 0.07, boxes that stand
behind each other at least 0.3."""


@dataclass(frozen=True, eq=False)
class _Side:
    """A region as one side of a hollow object: its patches, with their numbers of voxels."""

    middles: NDArray[np.float64]
    normals: NDArray[np.float64]
    weights: NDArray[np.float64]
    voxels: NDArray[np.float64]
    top: float

    @property
    def has_rim(self) -> bool:
        """Whether its surface is sideways and no level top closes it."""
        high = self.middles[:, 2] > self.top - _HIGH
        level = self.weights[high & (self.normals[:, 2] > _LEVEL)].sum()
        sideways = self.weights[np.abs(self.normals[:, 2]) < _UPRIGHT].sum()
        return bool(level <= _MOST_LEVEL * self.weights[high].sum() and sideways >= 0.5 * self.weights.sum())

    def facing(self, middle: NDArray[np.float64]) -> float:
        """Share of the sideways surface that faces a vertical line through `middle` (2,), 0 to 1."""
        sideways = np.abs(self.normals[:, 2]) < _UPRIGHT
        towards = ((middle - self.middles[:, :2]) * self.normals[:, :2]).sum(axis=1) > 0
        return float(self.weights[sideways & towards].sum() / self.weights[sideways].sum())

    @property
    def rim(self) -> NDArray[np.float64]:
        """(m, 2) places of its highest voxels, seen from above."""
        return self.voxels[self.voxels[:, 2] > self.top - _HIGH, :2]


def hollow_pairs(
    surface: SurfaceVoxels, patches: Supervoxels, regions: NDArray[np.int64], least: int
) -> Iterator[tuple[int, int]]:
    """Pairs (outside, inside) of regions that are the two sides of a hollow object; an inside has one outside.

    Parameters
    ----------
    surface, patches
        Voxels, z up, and patches of a surface.
    regions : (k,) int64
        Region of each patch, from 0.
    least : int
        Voxels of the smallest region that is looked at.
    """
    sides = list(_sides(surface, patches, regions, least))
    for inside_number, inside in sides:
        around = [
            (_apart(outside, inside), number)
            for number, outside in sides
            if number != inside_number and _are_two_sides(outside, inside)
        ]
        if around:
            yield min(around)[1], inside_number


def _sides(
    surface: SurfaceVoxels, patches: Supervoxels, regions: NDArray[np.int64], least: int
) -> Iterator[tuple[int, _Side]]:
    of_voxel = regions[patches.of_voxel]
    for number in np.flatnonzero(np.bincount(of_voxel) >= least).tolist():
        own, voxels = regions == number, surface.points[of_voxel == number]
        top = float(np.percentile(voxels[:, 2], 97))
        side = _Side(patches.middles[own], patches.normals[own], patches.counts[own].astype(float), voxels, top)
        if side.has_rim:
            yield number, side


def _are_two_sides(outside: _Side, inside: _Side) -> bool:
    from scipy.spatial import KDTree

    if abs(outside.top - inside.top) > _RIM:
        return False
    middle = (outside.voxels[:, :2].mean(axis=0) + inside.voxels[:, :2].mean(axis=0)) / 2
    if inside.facing(middle) < _FACING or outside.facing(middle) > 1 - _FACING:
        return False
    if _off_a_circle(np.concatenate([outside.rim, inside.rim])) > _ROUND:
        return False
    return bool(KDTree(outside.voxels).query(inside.voxels, distance_upper_bound=_TOUCH)[0].min() <= _TOUCH)


def _off_a_circle(places: NDArray[np.float64]) -> float:
    """Root mean square distance of places (m, 2) from the circle that fits them best, in radii."""
    columns = np.column_stack([places, np.ones(len(places))])
    x, y, rest = np.linalg.lstsq(columns, (places**2).sum(axis=1), rcond=None)[0]
    centre = np.array([x, y]) / 2
    radius = np.sqrt(max(float(rest + centre @ centre), 1e-9))
    return float(np.sqrt(np.mean((np.linalg.norm(places - centre, axis=1) - radius) ** 2)) / radius)


def _apart(first: _Side, second: _Side) -> float:
    """Horizontal distance of the middles of two sides, metres."""
    return float(np.linalg.norm(first.voxels[:, :2].mean(axis=0) - second.voxels[:, :2].mean(axis=0)))
