"""Objects that a nearer object parts: their surface goes on behind it, in the same planes.

Two patches continue each other if they lie in one plane and the camera sees a nearer object, and nothing behind
the plane, between them. Two regions are one object if much of both continues.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.view_image import ViewImage, lengths, rays_beside
from lifelore.perception.segmentation.supervoxels import Supervoxels

_PIXEL = 0.006
"""Radians; three points of a Kinect, so that a surface has no gaps in it."""
_ALIKE = np.cos(np.radians(15.0))
_APART = 0.010
"""Metres by which each of two patches may be off the plane of the other."""
_FAR = 0.35
"""Metres between two patches; more joins farther parts, through more that is not seen."""
_SEEN = 60_000
"""Points of the image; fewer leave gaps in surfaces."""
_STEPS = np.linspace(0.1, 0.9, 9)
"""Where the line between two patches is looked at."""
_BEFORE = 0.02
"""Metres by which a point is before or behind the line; more than the noise of the depth."""
_HIDDEN, _FREE = 0.15, 0.15
"""Least share of the line behind a nearer object, and largest share before a farther one."""
_CONTINUES = 0.4
"""Least share of both regions that continues in the other. Less joins equal boxes beside each other."""


def parted_pairs(
    patches: Supervoxels,
    regions: NDArray[np.int64],
    least: int,
    camera: NDArray[np.float64],
    seen: NDArray[np.float64],
) -> Iterator[tuple[int, int]]:
    """Pairs of regions that are parts of one object behind a nearer one.

    Parameters
    ----------
    patches : Supervoxels
    regions : (k,) int64
        Region of each patch, from 0.
    least : int
        Voxels of the smallest region that is looked at.
    camera : (3,) float64
    seen : (n, 3) float64
        All points that the camera sees, those of the table too.
    """
    sizes = np.bincount(regions, patches.counts)
    first, second = _coplanar(patches, regions, sizes >= least)
    if len(first) == 0:
        return
    steps = _STEPS[:, None, None]
    lines = ((1 - steps) * patches.middles[first] + steps * patches.middles[second] - camera).reshape(-1, 3)
    depths = lengths(lines)
    rays = seen[:: max(1, len(seen) // _SEEN)] - camera
    beside = rays[rays_beside(rays, lines / depths[:, None], 2 * _PIXEL)]
    if len(beside) == 0:
        return
    image = ViewImage(beside, _PIXEL)
    farthest = np.full(len(image.nearest), -np.inf)
    np.maximum.at(farthest, image.at, image.depths)
    at, known = image.pixels_of(lines)
    hidden, free = (
        (known & seen_there).reshape(len(_STEPS), -1).mean(axis=0)
        for seen_there in (image.nearest[at] < depths - _BEFORE, farthest[at] > depths + _BEFORE)
    )
    goes_on = (hidden >= _HIDDEN) & (free <= _FREE)
    first, second = first[goes_on], second[goes_on]
    ends = np.sort(np.stack([regions[first], regions[second]], axis=1), axis=1)
    for a, b in np.unique(ends, axis=0).tolist():
        of_pair = (ends == (a, b)).all(axis=1)
        members = np.union1d(first[of_pair], second[of_pair])
        shares = [patches.counts[members[regions[members] == end]].sum() / sizes[end] for end in (a, b)]
        if min(shares) >= _CONTINUES:
            yield a, b


def _coplanar(
    patches: Supervoxels, regions: NDArray[np.int64], large: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(p,) and (p,): patches of different `large` regions in one plane, each pair once."""
    own = np.flatnonzero(large[regions])
    middles, normals = patches.middles[own], patches.normals[own]
    off = np.abs(normals @ middles.T - np.einsum("ij,ij->i", normals, middles)[:, None])
    good = (normals @ normals.T >= _ALIKE) & (off <= _APART) & (off.T <= _APART)
    first, second = np.nonzero(np.triu(good & (regions[own][:, None] != regions[own])))
    near = np.linalg.norm(middles[first] - middles[second], axis=1) <= _FAR
    return own[first[near]], own[second[near]]
