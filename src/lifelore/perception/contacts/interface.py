"""`Interface`: contacts and separators of two near objects; `interfaces` finds all interfaces of a scene.

Thesis: §2.3.4 for a pair (`pair_networks` for two bare clouds), §2.3.6 for a scene. A literal reading (hard
margin, every contact of at least 7 support vectors) loses most contacts of a real depth camera; here a soft margin
gives the contacts, and each separator also gives one *dipole*: the α-weighted centroids of all support vectors on
either side, which always exist.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.contact_points import (
    ContactPoint,
    contact_clusters,
    contact_edges,
    contact_point,
    facing_clusters,
)
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.near_pairs import NearPair, near_pairs, split_objects
from lifelore.perception.separation.separator import MOST_WORK, Separator, separate

STANDARD_VOXEL = 0.003
"""Spacing (metres) at which `ContactSettings.cost` and `min_support` are stated."""
LEAST_SHARE = 1500.0
"""Kernel evaluations per point that a separator may always use, also in large scenes; more cost time.

On ordinary scenes half of the pairs need 230, one in a hundred 1140, the worst 1840, and a scene's own share of
`separator.MOST_WORK` is 12,000 and more. Clouds that lie in each other never converge.
"""
DEFAULT_CONTACT_SETTINGS = ContactSettings()


@dataclass(frozen=True, eq=False)
class Dipole:
    """Summary of a separator: mean support vector on either side, and direction.

    Parameters
    ----------
    length : float
        Kernel length of the separator, metres.
    first, second : (3,) float64
        α-weighted centroids of the support vectors of a and of b, metres.
    normal : (3,) float64
        Unit gradient at the mid-point, out of b into a; zeros where the separator is flat.
    """

    length: float
    first: NDArray[np.float64]
    second: NDArray[np.float64]
    normal: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Interface:
    """Contacts, separators and gap of a near pair of objects.

    Parameters
    ----------
    a, b : int
        Objects, a < b; or an object and `TABLE`.
    gap : float
        Visible gap, metres: the mean of the up to five smallest distances from a point of a to the nearest of b
        (`near_pairs.visible_gap`).
    contacts_a, contacts_b : tuple of ContactPoint
        Strongest first, at least one each; there may be none with `ContactSettings.as_printed`.
    contact_edges : (m, 2) int64
        Row (i, j): ``contacts_a[i]`` faces ``contacts_b[j]``.
    dipoles : tuple of Dipole
        One for each scale in `ContactSettings.scales`; with the table for the first alone.
    pair : NearPair, optional
        The two objects' points; `pair_features` needs them.
    max_violation : float
        How far the worst of its separators is from its optimum, see `Separator`; above 1e-3 only where clouds that
        lie in each other (mixed-up labels) used up the work. Infinite where it was never evaluated.
    """

    a: int
    b: int
    gap: float
    contacts_a: tuple[ContactPoint, ...]
    contacts_b: tuple[ContactPoint, ...]
    contact_edges: NDArray[np.int64]
    dipoles: tuple[Dipole, ...] = ()
    pair: NearPair | None = field(default=None, repr=False)
    max_violation: float = 0.0


def interfaces(
    cloud: LabelledCloud, settings: ContactSettings = DEFAULT_CONTACT_SETTINGS
) -> tuple[Interface, ...]:
    """The interfaces of all near pairs: objects in ascending order, then each object with the table.

    Deterministic: the same points give the same bits. The separators of a scene together may cost as much work as
    `separator.MOST_WORK`, divided by their numbers of points, with at least `LEAST_SHARE` per point.
    """
    if settings.voxel and len(cloud.points):
        cloud = voxelised(_without_far_table(cloud, 4 * settings.table_margin), settings.voxel)
    pairs = near_pairs(split_objects(cloud), settings.near, settings.table_margin)
    share = _share(pairs, settings)
    return tuple(interface(pair, settings, share) for pair in pairs)


def _without_far_table(cloud: LabelledCloud, margin: float) -> LabelledCloud:
    """Points and labels without what is `margin` metres beside the box of all objects; where that leaves no table,
    all points."""
    objects, (x, y, _) = cloud.labels > TABLE, cloud.points.T
    if not objects.any():
        return cloud
    keep = np.ones(len(objects), bool)
    for along in (x, y):
        low, high = along[objects].min() - margin, along[objects].max() + margin
        keep &= (along >= low) & (along <= high)
    if not (cloud.labels[keep] == TABLE).any():
        return cloud
    rows = np.flatnonzero(keep)
    return LabelledCloud(cloud.points.take(rows, axis=0), cloud.labels[rows])


def _share(pairs: Sequence[NearPair], settings: ContactSettings) -> float:
    """Kernel evaluations per point of each separator of a scene."""
    points = sum(_n_points(pair) * len(_scales(pair, settings)) for pair in pairs)
    return max(MOST_WORK / max(points, 1), LEAST_SHARE)


def interface(
    pair: NearPair, settings: ContactSettings = DEFAULT_CONTACT_SETTINGS, share: float = np.inf
) -> Interface:
    """One near pair's contacts and dipoles.

    Parameters
    ----------
    pair : NearPair
    settings : ContactSettings
    share : float
        Kernel evaluations per point of a separator, > 0, at most `separator.MOST_WORK` in all.
    """
    scales = _scales(pair, settings)
    max_work = min(share * _n_points(pair), MOST_WORK)
    found = [
        separate(pair.first.points, pair.second.points, length=length, cost=cost, max_work=max_work)
        for length, cost in scales
    ]
    sides = list(_contacts(pair, found[0], settings))
    points_a, points_b = ([cluster for cluster, _ in side] for side in sides)
    return Interface(
        a=pair.first.label,
        b=pair.second.label,
        gap=pair.gap,
        contacts_a=tuple(contact for _, contact in sides[0]),
        contacts_b=tuple(contact for _, contact in sides[1]),
        contact_edges=contact_edges(points_a, points_b),
        dipoles=tuple(_dipole(pair, one, length) for one, (length, _) in zip(found, scales, strict=True)),
        pair=pair,
        max_violation=max(one.max_violation for one in found),
    )


def _scales(pair: NearPair, settings: ContactSettings) -> list[tuple[float, float]]:
    """(length, cost) of each separator of a pair, the cost per point at this density."""
    # Relations with the table are judged by heights: the narrow separator gives contacts, the wide one no feature.
    scales = settings.scales[:1] if pair.second.label == TABLE else settings.scales
    per_point = (settings.voxel / STANDARD_VOXEL) ** 2 if settings.voxel else 1.0
    return [(length, cost * per_point) for length, cost in scales]


def _n_points(pair: NearPair) -> int:
    return len(pair.first.points) + len(pair.second.points)


def _contacts(pair: NearPair, found: Separator, settings: ContactSettings):
    """(support vectors, contact point) of each contact, on either side."""
    sides = (
        (pair.first.points[found.support_first], found.alpha_first, 1.0, pair.second.label),
        (pair.second.points[found.support_second], found.alpha_second, -1.0, pair.first.label),
    )
    both = _clusters(sides[0][:2], sides[1][:2], settings)
    for (points, alpha, sign, other), clusters in zip(sides, both, strict=True):
        weights = np.ones(len(alpha)) if settings.as_printed else alpha
        places = np.array([weights[rows] @ points[rows] / weights[rows].sum() for rows in clusters]).reshape(-1, 3)
        normals = sign * _unit(found.gradient(places))
        yield [
            (points[rows], contact_point(place, points[rows], alpha[rows], normal, other))
            for rows, place, normal in zip(clusters, places, normals, strict=True)
        ]


def _clusters(
    first: tuple[NDArray[np.float64], NDArray[np.float64]],
    second: tuple[NDArray[np.float64], NDArray[np.float64]],
    settings: ContactSettings,
) -> tuple[list[NDArray[np.int64]], list[NDArray[np.int64]]]:
    """Rows of each contact's support vectors, from (support vectors, α) of either object."""
    linkage, least = settings.linkage, settings.min_support
    if settings.as_printed:
        return contact_clusters(*first, linkage, least), contact_clusters(*second, linkage, least)
    scale = (STANDARD_VOXEL / settings.voxel) ** 2 if settings.voxel else 1.0
    return facing_clusters(*first, *second, linkage, least * scale)


def _dipole(pair: NearPair, found: Separator, length: float) -> Dipole:
    ours = pair.first.points[found.support_first]
    theirs = pair.second.points[found.support_second]
    first = found.alpha_first @ ours / found.alpha_first.sum()
    second = found.alpha_second @ theirs / found.alpha_second.sum()
    normal = _unit(found.gradient((first + second)[None] / 2))[0]
    return Dipole(length, first, second, normal)


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each row scaled to length 1; rows of zeros stay."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0)
