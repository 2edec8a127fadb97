"""`PokedSegments`: a segmentation corrected by pushes: parts that move together merge, others split.

All evidence is about the patches of the first cloud's surface and their motions (`poked_patches`). Two parts of a
segment that moved apart more often than together belong to different objects. Two segments merge if
they moved together more often than apart, and a push on each of them moved both: a pushed base carries its load
along, but a pushed load leaves the base.

Thesis: §2.4.3 (objects may be glued together; "only the incorporation of actions to perturb the scene such as
poking and prodding would lead to a guaranteed correct object segmentation"), §2.5.
"""

from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from reproduction.chapter5.c5_07_poking.poked_patches import DECIDED, LEAST_DECIDED, PokedPatches

SMALLEST = 100
"""Voxels of the smallest part that is split off: 25 cm²."""


class PokedSegments(PokedPatches):
    """Segments of a first cloud, followed through pushes and corrected by them."""

    def corrected(self) -> NDArray[np.int64]:
        """(n,) labels of the first cloud after all pushes so far; objects are 2 … by size."""
        labels = self.first.labels.copy()
        if self._surface is None:
            return labels
        parts = self._parts()
        of_patch = self._groups(parts)[parts]
        order = np.argsort(-np.bincount(of_patch, self._counts), kind="stable")
        label = np.empty(len(order), np.int64)
        label[order] = np.arange(2, 2 + len(order))
        labels[self._rows] = label[of_patch][self._patch][self._surface.inverse]
        return labels

    def _parts(self) -> NDArray[np.int64]:
        """The part of each patch, segments being cut where pushes moved them apart."""
        part = np.unique(self._segment, return_inverse=True)[1].reshape(-1)
        for motion in self._motions:
            for old in range(part.max() + 1):
                rows = np.flatnonzero(part == old)
                known = rows[motion[rows] >= 0]
                kinds, sizes = _sizes(motion[known], self._counts[known])
                kinds = kinds[sizes >= SMALLEST]
                if len(kinds) < 2:
                    continue
                target = self._nearest_kind(rows, motion, kinds)
                for kind in kinds[1:]:
                    piece, rest = rows[target == kind], rows[target == kinds[0]]
                    apart, together = self._moved(piece, rest)
                    if apart > together:
                        part[piece] = part.max() + 1
        return part

    def _nearest_kind(self, rows: NDArray, motion: NDArray, kinds: NDArray) -> NDArray:
        """For each patch its own motion among `kinds`, or that of the nearest patch that has one of them."""
        assert self._surface is not None
        own = motion[rows]
        clear = np.isin(own, kinds)
        middles = np.stack(
            [np.bincount(self._patch, self._surface.points[:, axis]) / self._counts for axis in range(3)], axis=1
        )
        nearest = KDTree(middles[rows[clear]]).query(middles[rows])[1]
        return np.where(clear, own, own[clear][nearest])

    def _groups(self, parts: NDArray[np.int64]) -> NDArray[np.int64]:
        """The object of each part."""
        rows = [np.flatnonzero(parts == part) for part in range(int(parts.max()) + 1)]
        segment = [int(self._segment[own[0]]) for own in rows]
        pairs = combinations(range(len(rows)), 2)
        joined = [(a, b) for a, b in pairs if segment[a] != segment[b] and self._alike(rows[a], rows[b])]
        links = np.zeros((len(rows), len(rows)), bool)
        links[tuple(np.array(joined, np.int64).reshape(-1, 2).T)] = True
        return connected_components(links, directed=False)[1]

    def _alike(self, first: NDArray, second: NDArray) -> bool:
        """Whether more pushes moved two parts alike than apart, and a push on each of them moved both."""
        alike = [n for n in range(len(self._motions)) if self._comparison(n, first, second) > 0]
        touched = {self._touched[n] for n in alike}
        pushed = all(int(self._segment[rows[0]]) in touched for rows in (first, second))
        return pushed and len(alike) > self._moved(first, second)[0]

    def _moved(self, first: NDArray, second: NDArray) -> tuple[int, int]:
        """Pushes that moved two sets of patches apart, and that moved them alike."""
        found = [self._comparison(number, first, second) for number in range(len(self._motions))]
        return sum(x < 0 for x in found), sum(x > 0 for x in found)

    def _comparison(self, number: int, first: NDArray, second: NDArray) -> int:
        """1 if a push moved two sets of patches alike, −1 if apart, 0 if it left them or does not tell."""
        motion, costs = self._motions[number], self._costs[number]
        a, b = self._motion_of(motion, first), self._motion_of(motion, second)
        if a < 0 or b < 0 or a == b == 0:
            return 0
        others = (0, 0) if a == b else (b, a)
        for rows, own, other in zip((first, second), (a, b), others, strict=True):
            need = max(LEAST_DECIDED, DECIDED * float(self._counts[rows].sum()))
            if float((costs[rows, other] - costs[rows, own]).sum()) < need:
                return 0
        return 1 if a == b else -1

    def _motion_of(self, motion: NDArray, rows: NDArray) -> int:
        """The motion of most voxels of some patches."""
        kinds, sizes = _sizes(motion[rows], self._counts[rows])
        return int(kinds[sizes.argmax()])


def _sizes(kinds: NDArray[np.int64], counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The different kinds, largest first, and their sizes."""
    found, inverse = np.unique(kinds, return_inverse=True)
    sizes = np.bincount(inverse.reshape(-1), counts, len(found))
    order = np.argsort(-sizes, kind="stable")
    return found[order], sizes[order].astype(np.float64)
