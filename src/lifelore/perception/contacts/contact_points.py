"""Contact points from support vectors: connected components, each with position, normal and extent.

Thesis: §2.3.4. Clusters are connected components under a length (single linkage), which keeps the same clusters
when most points are thrown away; X-means and density clusterings cut one continuous strip of contact at random.
The thesis clusters each object separately; here the support vectors of both objects take part (`facing_clusters`):
where part of a contact is hidden on one object, the other object keeps it one contact.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel


@dataclass(frozen=True, eq=False)
class ContactPoint:
    """A cluster of support vectors of one object towards another (thesis §2.3.4, χ).

    Parameters
    ----------
    position : (3,) float64
        Centroid, metres: weighted by α, or the plain mean with `ContactSettings.as_printed`.
    normal : (3,) float64
        Unit vector out of the other object into this one, across the separating surface.
    extent : (3,) float64
        Lengths of the cluster along its principal axes, metres, descending.
    strength : float
        Sum of α over the cluster, > 0.
    n_support : int
        Support vectors in the cluster, ≥ 1.
    other : int
        The other object.
    """

    position: NDArray[np.float64]
    normal: NDArray[np.float64]
    extent: NDArray[np.float64]
    strength: float
    n_support: int
    other: int


@kernel
def linked(points: NDArray[np.float64], reach: float) -> NDArray[np.int64]:
    """Component of each point when points at most `reach` apart are linked, (k,) numbered by first member."""
    n = len(points)
    component, waiting = np.full(n, -1), np.empty(n, np.int64)
    count = 0
    for seed in range(n):
        if component[seed] >= 0:
            continue
        component[seed] = count
        waiting[0] = seed
        top = 1
        while top > 0:
            top -= 1
            i = waiting[top]
            for j in range(n):
                if component[j] < 0:
                    dx = points[i, 0] - points[j, 0]
                    dy = points[i, 1] - points[j, 1]
                    dz = points[i, 2] - points[j, 2]
                    if dx * dx + dy * dy + dz * dz <= reach * reach:
                        component[j] = count
                        waiting[top] = j
                        top += 1
        count += 1
    return component


def contact_clusters(
    points: NDArray[np.float64], alpha: NDArray[np.float64], linkage: float, min_support: float
) -> list[NDArray[np.int64]]:
    """Rows of each contact's support vectors on one object alone, strongest contact first (thesis §2.3.4).

    Parameters
    ----------
    points : (k, 3) float64
        Support vectors of one object.
    alpha : (k,) float64
        Their multipliers, > 0.
    linkage : float
        Metres.
    min_support : float
        Smaller clusters are discarded; there may be none left.
    """
    return _strongest_first(linked(np.ascontiguousarray(points), linkage), alpha, min_support)


def facing_clusters(
    first: NDArray[np.float64],
    alpha_first: NDArray[np.float64],
    second: NDArray[np.float64],
    alpha_second: NDArray[np.float64],
    linkage: float,
    min_support: float,
) -> tuple[list[NDArray[np.int64]], list[NDArray[np.int64]]]:
    """As `contact_clusters` on either object, where links may lead through the other's support vectors.

    The strongest cluster of either object is never discarded.

    Parameters
    ----------
    first, second : (k, 3), (m, 3) float64
        Support vectors of the two objects, metres.
    alpha_first, alpha_second : (k,), (m,) float64
    linkage, min_support : float
    """
    component = linked(np.concatenate([first, second]), linkage)
    found = []
    for own, alpha in ((component[: len(first)], alpha_first), (component[len(first) :], alpha_second)):
        found.append(_strongest_first(own, alpha, min_support, at_least=1))
    return found[0], found[1]


def _strongest_first(
    component: NDArray[np.int64], alpha: NDArray[np.float64], min_support: float, at_least: int = 0
) -> list[NDArray[np.int64]]:
    """Rows of each component, by strength, without those of too few rows; but the first `at_least` in any case."""
    order = np.argsort(-np.bincount(component, weights=alpha), kind="stable")
    kept = order[np.bincount(component)[order] >= max(min_support, 1)]
    return [np.flatnonzero(component == number) for number in (kept if len(kept) else order[:at_least])]


def contact_point(
    position: NDArray[np.float64],
    points: NDArray[np.float64],
    alpha: NDArray[np.float64],
    normal: NDArray[np.float64],
    other: int,
) -> ContactPoint:
    """One contact at `position`: extent along principal axes, strength Σα."""
    return ContactPoint(
        position=position,
        normal=normal,
        extent=extent(points),
        strength=float(alpha.sum()),
        n_support=len(points),
        other=other,
    )


def extent(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lengths along the principal axes, (3,) descending, metres."""
    centred = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(centred.T @ centred)
    along = centred @ axes
    return np.sort(along.max(axis=0) - along.min(axis=0))[::-1]


def contact_edges(first: list[NDArray[np.float64]], second: list[NDArray[np.float64]]) -> NDArray[np.int64]:
    """Pairs of contacts that face each other, (m, 2) ascending.

    Each contact faces the contact on the other side that is closest to its support vectors.
    """
    if not first or not second:
        return np.empty((0, 2), np.int64)
    between = np.array([[closest(p, q) for q in second] for p in first])
    edges = {(i, int(j)) for i, j in enumerate(between.argmin(axis=1))}
    edges |= {(int(i), j) for j, i in enumerate(between.argmin(axis=0))}
    return np.array(sorted(edges), np.int64)


@kernel
def closest(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    """Smallest distance between two sets of points, metres."""
    best = np.inf
    for i in range(len(first)):
        for j in range(len(second)):
            dx = first[i, 0] - second[j, 0]
            dy = first[i, 1] - second[j, 1]
            dz = first[i, 2] - second[j, 2]
            best = min(best, dx * dx + dy * dy + dz * dz)
    return np.sqrt(best)
