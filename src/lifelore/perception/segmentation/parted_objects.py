"""Objects that a nearer object parts: their surface goes on behind it, in the same planes.

Two patches continue each other if they lie in one plane and the camera sees a nearer object, and nothing behind
the plane, between them. Two regions are one object if much of both continues.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.perception.segmentation.free_space import View, behind
from lifelore.perception.segmentation.supervoxels import Supervoxels

_ALIKE = np.cos(np.radians(15.0))
_APART = 0.010
"""Metres by which each of two patches may be off the plane of the other."""
_FAR = 0.35
"""Metres between two patches; more joins farther parts, through more that is not seen."""
_STEPS = np.linspace(0.1, 0.9, 9)
"""Where the line between two patches is looked at."""
_BEFORE = 0.02
"""Metres by which a point is before or behind the line; more than the noise of the depth."""
_HIDDEN, _FREE = 0.15, 0.15
"""Least share of the line behind a nearer object, and largest share before a farther one."""
_CONTINUES = 0.4
"""Least share of both regions that continues in the other. Less joins equal boxes beside each other."""


def parted_pairs(
    patches: Supervoxels, regions: NDArray[np.int64], least: int, view: View
) -> Iterator[tuple[int, int]]:
    """Pairs of regions that are parts of one object behind a nearer one.

    Parameters
    ----------
    patches : Supervoxels
    regions : (k,) int64
        Region of each patch, from 0.
    least : int
        Voxels of the smallest region that is looked at.
    view : View
        Of all points that the camera sees, those of the table too.
    """
    sizes = np.bincount(regions, patches.counts)
    found = continued_pairs(patches, regions, sizes >= least, view)
    first, second = np.array(found, np.int64).reshape(-1, 2).T
    ends = np.sort(np.stack([regions[first], regions[second]], axis=1), axis=1)
    for a, b in np.unique(ends, axis=0).tolist():
        of_pair = (ends == (a, b)).all(axis=1)
        members = np.union1d(first[of_pair], second[of_pair])
        shares = [patches.counts[members[regions[members] == end]].sum() / sizes[end] for end in (a, b)]
        if min(shares) >= _CONTINUES:
            yield a, b


@kernel
def continued_pairs(patches, regions, large, view):
    """Numbers of two patches of different `large` regions that lie in one plane, behind a nearer object between
    them, each pair once, ascending.

    At 700 patches this is seven times as fast as matrices of all pairs.
    """
    found, middles, normals = [(0, 0) for _ in range(0)], patches.middles, patches.normals
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
            if cosine < _ALIKE or max(abs(off_i), abs(off_j)) > _APART or away > _FAR * _FAR:
                continue
            hidden = free = 0
            for step in _STEPS:
                nearest, farthest = behind((1 - step) * middles[i] + step * middles[j], view)
                hidden += nearest < -_BEFORE
                free += farthest > _BEFORE
            if hidden >= _HIDDEN * len(_STEPS) and free <= _FREE * len(_STEPS):
                found.append((i, j))
    return found
