"""Merging of patches into objects: the two regions with the strongest evidence along their border join first."""

import heapq
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.perception.segmentation.free_space import View, free_share
from lifelore.perception.segmentation.supervoxels import Supervoxels

_STRONG = 3.5
"""Mean evidence from which two regions merge whatever is free between them; more costs time."""
_FREE = 0.05
"""Share of free places between two regions, beyond that within either, from which they stay apart. More joins what
touches at corners, less splits what is hollow."""
_FREE_UNEVEN = 0.01
"""The same where one region ends higher than the other, as inside and outside of a hollow object do not."""
_UNEVEN = 0.015
"""Metres between the heights of the highest patches of two regions that end at different heights."""
_SAMPLE = 16
"""Patches of a region from which lines are drawn."""


def merged(
    patches: Supervoxels, evidence: NDArray[np.float64], least: int, voxel: float, view: View
) -> NDArray[np.int64]:
    """(k,) int64: region of each patch, from 0.

    The evidence between two regions is the mean over their border, weighed by its length. The pair with the
    greatest mean is merged until no mean is above 0. So a few pairs of convex patches do not merge two objects
    that meet in a long crease, and a few concave pairs do not split a box along an edge. Two large regions stay
    apart where the evidence is weak and the camera sees through the space between them (`free_share`); less
    of it is enough where they end at different heights.

    Parameters
    ----------
    patches : Supervoxels
    evidence : (e,) float64
        Log odds of one object, of each pair of patches.
    least : int
        Voxels of the smallest large region.
    voxel : float
        Length of the surface's voxels, metres.
    view : View
    """
    owner = _owners(patches, evidence, least, voxel, view)
    return np.unique(owner, return_inverse=True)[1].reshape(-1).astype(np.int64)


@kernel
def _owners(patches, evidence, least, voxel, view):
    """(k,) int64: a patch of the region of each patch, the same for all of a region.

    At 700 patches this is six times as fast as dictionaries of borders.
    """
    n, pairs = len(patches.counts), patches.pairs
    border, total = patches.borders.astype(np.float64), patches.borders * evidence
    # At side h % 2 of border h // 2 is region ends[h], -1 where the border has gone; a region's sides are a chain.
    ends, first, following = pairs.copy().reshape(-1), np.full(n, -1), np.empty(2 * len(pairs), np.int64)
    for h in range(len(ends)):
        following[h], first[ends[h]] = first[ends[h]], h
    # Mean evidence, negative so that the greatest comes first; two regions, the lower number first; their border.
    queue: list[Any] = [
        (-total[e] / border[e], pairs[e, 0], pairs[e, 1], e) for e in range(len(pairs)) if total[e] > 0
    ]
    heapq.heapify(queue)
    owner, shared, voxels = np.arange(n), np.full(n, -1), patches.counts.copy()
    while len(queue):
        key, a, b, e = heapq.heappop(queue)
        if _regions(ends, e) != (a, b) or key != -total[e] / border[e]:
            continue  # the border has grown since
        if -key < _STRONG and min(voxels[a], voxels[b]) >= least:
            of_a, of_b = np.flatnonzero(owner == a), np.flatnonzero(owner == b)
            if _free_between(of_a, of_b, patches, voxel, view):
                continue
        owner[owner == b] = a
        voxels[a] += voxels[b]
        ends[2 * e] = ends[2 * e + 1] = -1
        h = first[a]
        while h >= 0:
            if ends[h] == a:
                shared[ends[h ^ 1]] = h // 2
            h = following[h]
        h = first[b]
        while h >= 0:
            e, after = h // 2, following[h]
            if ends[h] == b:
                other = ends[h ^ 1]
                ours = shared[other]
                if ours >= 0 and _regions(ends, ours) == (min(a, other), max(a, other)):
                    ends[h] = ends[h ^ 1] = -1
                    border[ours] += border[e]
                    total[ours] += total[e]
                    e = ours
                else:
                    ends[h], following[h], first[a] = a, first[a], h
                if total[e] > 0:
                    heapq.heappush(queue, (-total[e] / border[e], min(a, other), max(a, other), e))
            h = after
    return owner


@inlined
def _free_between(first, second, patches, voxel, view):
    """Whether the camera sees through more of the space between two regions than within either."""
    uneven = abs(patches.middles[first, 2].max() - patches.middles[second, 2].max()) > _UNEVEN
    first, second = _some(first), _some(second)
    within = max(free_share(first, first, patches, voxel, view), free_share(second, second, patches, voxel, view))
    return free_share(first, second, patches, voxel, view) > within + (_FREE_UNEVEN if uneven else _FREE)


@inlined
def _some(own):
    """At most `_SAMPLE` of the patches of a region, evenly by their numbers, which ascend with their places."""
    return own[:: (len(own) + _SAMPLE - 1) // _SAMPLE]


@inlined
def _regions(ends, border):
    """The two regions at a border, the lower number first; -1 and -1 where the border has gone."""
    return min(ends[2 * border], ends[2 * border + 1]), max(ends[2 * border], ends[2 * border + 1])


def absorbed(
    regions: NDArray[np.int64],
    pairs: NDArray[np.int64],
    borders: NDArray[np.int64],
    weakness: Callable[[NDArray[np.int64]], NDArray[np.float64]],
) -> NDArray[np.int64]:
    """(n,) int64: the regions, the weakest first merged into the neighbour of the longest border.

    Parameters
    ----------
    regions : (n,) int64
        Region of each patch.
    pairs, borders
        As of `Supervoxels`.
    weakness : function
        From regions (n,) to a number for each, lower is weaker; infinite for regions that stay. A region without
        neighbours stays too.
    """
    regions = regions.copy()
    while True:
        ends = regions[pairs].reshape(-1, 2)
        at_border = ends[:, 0] != ends[:, 1]
        weak = weakness(regions)
        weakest = np.intersect1d(np.flatnonzero(np.isfinite(weak)), ends[at_border])
        if len(weakest) == 0:
            return np.unique(regions, return_inverse=True)[1].reshape(-1).astype(np.int64)
        region = weakest[weak[weakest].argmin()]
        own = at_border & (ends == region).any(axis=1)
        others = np.where(ends[own, 0] == region, ends[own, 1], ends[own, 0])
        regions[regions == region] = np.bincount(others, borders[own]).argmax()
