"""Objects that a nearer object parts: their surface goes on behind it, in the same planes.

Two patches continue each other if they lie in one plane and the camera sees a nearer object, and nothing behind
the plane, between them. Two regions are one object if much of both continues.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.perception.clouds.view_image import ViewImage, lengths
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


class SeenImage(ViewImage):
    """The distances of the nearest and of the farthest point in each pixel.

    Parameters
    ----------
    seen : (n, 3) float64
        All points that the camera sees, those of the table too.
    camera : (3,) float64
    """

    def __init__(self, seen: NDArray[np.float64], camera: NDArray[np.float64]) -> None:
        super().__init__(seen[:: max(1, len(seen) // _SEEN)] - camera, _PIXEL)
        self.camera = camera
        self.farthest = np.full(len(self.nearest), -np.inf)
        np.maximum.at(self.farthest, self.at, self.depths)


def parted_pairs(
    patches: Supervoxels, regions: NDArray[np.int64], least: int, image: SeenImage
) -> Iterator[tuple[int, int]]:
    """Pairs of regions that are parts of one object behind a nearer one.

    Parameters
    ----------
    patches : Supervoxels
    regions : (k,) int64
        Region of each patch, from 0.
    least : int
        Voxels of the smallest region that is looked at.
    image : SeenImage
    """
    sizes = np.bincount(regions, patches.counts)
    coplanar = coplanar_pairs(patches.middles, patches.normals, regions, sizes >= least)
    if not coplanar:
        return
    first, second = np.array(coplanar).T
    steps = _STEPS[:, None, None]
    lines = ((1 - steps) * patches.middles[first] + steps * patches.middles[second] - image.camera).reshape(-1, 3)
    depths = lengths(lines)
    at, known = image.pixels_of(lines)
    hidden, free = (
        (known & seen_there).reshape(len(_STEPS), -1).mean(axis=0)
        for seen_there in (image.nearest[at] < depths - _BEFORE, image.farthest[at] > depths + _BEFORE)
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


@kernel
def coplanar_pairs(middles, normals, regions, large):
    """Numbers of two patches of different `large` regions that lie in one plane, each pair once, ascending.

    At 700 patches this is seven times as fast as matrices of all pairs.
    """
    found = [(0, 0) for _ in range(0)]
    for i in range(len(regions)):
        for j in range(i + 1, len(regions)):
            if regions[i] == regions[j] or not (large[regions[i]] and large[regions[j]]):
                continue
            cosine = off_i = off_j = away = 0.0
            for axis in range(3):
                apart = middles[j, axis] - middles[i, axis]
                cosine += normals[i, axis] * normals[j, axis]
                off_i += normals[i, axis] * apart
                off_j += normals[j, axis] * apart
                away += apart * apart
            if cosine >= _ALIKE and max(abs(off_i), abs(off_j)) <= _APART and away <= _FAR * _FAR:
                found.append((i, j))
    return found
