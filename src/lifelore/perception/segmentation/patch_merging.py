"""Merging of patches into objects: the two regions with the strongest evidence along their border join first."""

import heapq
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

_Link = tuple[int, float]
"""Length of a border, and the sum of the evidence along it."""
_Entry = tuple[float, int, int, _Link]
"""Mean evidence, negative so that the greatest comes first; two regions, the lower number first; their link."""


def merged(
    n: int, pairs: NDArray[np.int64], borders: NDArray[np.int64], evidence: NDArray[np.float64]
) -> NDArray[np.int64]:
    """(n,) int64: region of each patch, from 0.

    The evidence between two regions is the mean over their border, weighed by its length. The pair with the
    greatest mean is merged until no mean is above 0. So a few pairs of convex patches do not merge two objects
    that meet in a long crease, and a few concave pairs do not split a box along an edge.

    Parameters
    ----------
    n : int
        Number of patches.
    pairs, borders, evidence : (e, 2), (e,) and (e,)
        As of `Supervoxels`, and log odds of one object.
    """
    beside: list[dict[int, _Link]] = [{} for _ in range(n)]
    queue: list[_Entry] = []
    for (a, b), border, odds in zip(pairs.tolist(), borders.tolist(), evidence.tolist(), strict=True):
        link = beside[a][b] = beside[b][a] = (border, border * odds)
        if odds > 0:
            queue.append((-link[1] / border, a, b, link))
    heapq.heapify(queue)
    owner = np.arange(n)
    while queue:
        _, a, b, link = heapq.heappop(queue)
        if beside[a].get(b) is link:  # else the border has grown since
            _join(a, b, beside, queue)
            owner[b] = a
    while (owner[owner] != owner).any():
        owner = owner[owner]
    return np.unique(owner, return_inverse=True)[1].reshape(-1).astype(np.int64)


def _join(a: int, b: int, beside: list[dict[int, _Link]], queue: list[_Entry]) -> None:
    """Give all borders of region `b` to region `a`."""
    ours = beside[a]
    del ours[b]
    for other, (border, total) in beside[b].items():
        if other == a:
            continue
        theirs = beside[other]
        del theirs[b]
        if other in ours:
            known_border, known_total = ours[other]
            border, total = known_border + border, known_total + total
        link = ours[other] = theirs[a] = (border, total)
        if total > 0:
            first, second = (a, other) if a < other else (other, a)
            heapq.heappush(queue, (-total / border, first, second, link))
    beside[b] = {}


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
