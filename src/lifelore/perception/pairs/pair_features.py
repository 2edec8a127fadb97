"""`pair_features`: a row of named features for each near pair of a scene, in both orders of the two objects.

The displacement between contact points is the thesis's feature (§2.3.5). Alone it is ambiguous: a tall box behind
a short one makes the same crease as a box on a box. The separator's normal and the height of the contact relative
to both objects distinguish them. All columns but the last four are the same for any turn of the scene about the
vertical.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.contacts.interface import Interface, interfaces
from lifelore.perception.contacts.near_pairs import ObjectCloud
from lifelore.perception.contacts.object_shape import ObjectShape
from lifelore.perception.pairs.objects_between import BETWEEN_COLUMNS, ObjectsBetween

Array = NDArray[np.float64]
N_SCALES = 2
SCALE_COLUMNS = (
    "horizontal", "rise", "elevation", "distance", "normal_up", "below_a", "above_a", "below_b", "above_b",
    "below_a_share", "above_b_share", "above_a_share", "below_b_share",
)  # fmt: skip
GEOMETRY_COLUMNS = (
    "gap", "foot_a", "foot_b", "top_a", "top_b", "height_a", "height_b", "width_a", "width_b",
    "foot_a_over_top_b", "foot_b_over_top_a", "overlap_share_a", "overlap_share_b", "centre_rise",
    "centre_horizontal", "a_over_b", "b_over_a", "low_a_over_b", "low_b_over_a", "points_below_a",
    "points_above_b", "points_above_a", "points_below_b",
)  # fmt: skip
VIEW_COLUMNS = ("behind", "right", "contact_behind", "contact_right")


@dataclass(frozen=True, eq=False)
class PairFeatures:
    """One row for each ordered pair.

    Parameters
    ----------
    names : tuple of str
        Names of the columns; lengths in metres, angles in radians, shares in [0, 1].
    matrix : (n, d) float64
        Finite.
    pairs : (n, 2) int64
        The ordered pair (a, b) of each row. Row 2i is interface i, row 2i + 1 the same in the other order.
    gaps : (n,) float64
        Visible gap, metres.
    """

    names: tuple[str, ...]
    matrix: Array
    pairs: NDArray[np.int64]
    gaps: Array

    def columns(self, names: Sequence[str]) -> Array:
        """The named columns, ``(n, len(names))``.

        Raises
        ------
        InputError
            A name that is no column.
        """
        missing = [name for name in names if name not in self.names]
        if missing:
            raise InputError(f"columns must be among {', '.join(self.names)}; got {', '.join(missing)}")
        return self.matrix[:, [self.names.index(name) for name in names]]


def pair_features(cloud: LabelledCloud, found: Sequence[Interface] | None = None) -> PairFeatures:
    """Features of all near pairs of a scene.

    Parameters
    ----------
    cloud : LabelledCloud
    found : sequence of Interface, optional
        The scene's interfaces, if already computed.
    """
    found = interfaces(cloud) if found is None else found
    names = COLUMNS
    pairs = np.array([[one.a, one.b, one.b, one.a] for one in found], np.int64).reshape(-1, 2)
    gaps = np.repeat([one.gap for one in found], 2).astype(float)
    if not found:
        return PairFeatures(names, np.empty((0, len(names))), pairs, gaps)
    objects_between = ObjectsBetween(found)
    rows = [row for one in found for row in _both_ways(one, objects_between, cloud.camera)]
    return PairFeatures(names, np.array(rows), pairs, gaps)


def column_names(n_scales: int) -> tuple[str, ...]:
    """Names of all columns: of each scale, of geometry, of a third object, of the camera's view."""
    scaled = [f"{name}_{scale}" for scale in range(n_scales) for name in SCALE_COLUMNS]
    return (*scaled, *GEOMETRY_COLUMNS, *BETWEEN_COLUMNS, *VIEW_COLUMNS)


COLUMNS = column_names(N_SCALES)
TURNING_COLUMNS = COLUMNS[: -len(VIEW_COLUMNS)]
"""The columns that stay the same when scene and camera are turned about the vertical by different angles."""


def _bodies(one: Interface) -> tuple[ObjectCloud, ObjectCloud]:
    if one.pair is None:
        raise InputError(f"the interface of {one.a} and {one.b} carries no points; make it with interfaces()")
    return one.pair.first, one.pair.second


def _both_ways(
    one: Interface,
    objects_between: ObjectsBetween,
    camera: NDArray[np.float64] | None,
) -> Array:
    """The rows of (a, b) and of (b, a), ``(2, d)``."""
    first, second = (body.shape for body in _bodies(one))
    over = first.over(second), second.over(first)
    # With the table there is one scale; its columns are repeated for the others.
    dipoles = (one.dipoles + one.dipoles[-1:] * N_SCALES)[:N_SCALES]
    middles = np.array([(dipole.first + dipole.second) / 2 for dipole in dipoles])
    displacements = np.array([dipole.first - dipole.second for dipole in dipoles])
    normals = np.array([dipole.normal for dipole in dipoles])
    way, gap_first, gap_second = objects_between.between(one.a, one.b, middles[0])
    return np.array(
        [
            np.concatenate(
                [
                    _scale_columns(sign * displacements, sign * normals, middles, a, b).ravel(),
                    _geometry_columns(a, b, a_over, b_over, one.gap, middles[0, 2]),
                    between,
                    _view_columns(a, b, sign * displacements[0], middles[0], camera),
                ]
            )
            for sign, a, b, (a_over, b_over), between in (
                (1.0, first, second, over, (way, gap_first, gap_second)),
                (-1.0, second, first, over[::-1], (way, gap_second, gap_first)),
            )
        ]
    )


def _scale_columns(displacement: Array, normal: Array, middle: Array, a: ObjectShape, b: ObjectShape) -> Array:
    """Displacement, normal and contact heights at each scale, ``(n_scales, len(SCALE_COLUMNS))``."""
    horizontal = np.hypot(displacement[:, 0], displacement[:, 1])
    rise = displacement[:, 2]
    z = middle[:, 2]
    below_a, above_a, below_b, above_b = z - a.foot, a.top - z, z - b.foot, b.top - z
    return np.stack(
        [
            horizontal, rise, np.arctan2(rise, horizontal), np.hypot(horizontal, rise), normal[:, 2],
            below_a, above_a, below_b, above_b,
            below_a / a.height, above_b / b.height, above_a / a.height, below_b / b.height,
        ],
        axis=1,
    )  # fmt: skip


def _geometry_columns(
    a: ObjectShape,
    b: ObjectShape,
    a_over: NDArray[np.bool_],
    b_over: NDArray[np.bool_],
    gap: float,
    contact: float,
) -> list[Any]:
    overlap = min(a.top, b.top) - max(a.foot, b.foot)
    centre = a.centre - b.centre
    return [
        gap, a.foot, b.foot, a.top, b.top, a.height, b.height, a.width, b.width,
        a.foot - b.top, b.foot - a.top, overlap / a.height, overlap / b.height, centre[2],
        float(np.hypot(centre[0], centre[1])), a_over.mean(), b_over.mean(),
        _share(a_over, a.low), _share(b_over, b.low),
        (a.sample[:, 2] < contact).mean(), (b.sample[:, 2] > contact).mean(),
        (a.sample[:, 2] > contact).mean(), (b.sample[:, 2] < contact).mean(),
    ]  # fmt: skip


def _share(which: NDArray[np.bool_], among: NDArray[np.bool_]) -> float:
    return float(which[among].mean()) if among.any() else 0.0


def _view_columns(
    a: ObjectShape, b: ObjectShape, displacement: Array, middle: Array, camera: NDArray[np.float64] | None
) -> list[float]:
    """How far a lies behind and to the right of b as the camera sees the pair, by centres and by contacts.

    Zeros without a camera.
    """
    if camera is None:
        return [0.0] * len(VIEW_COLUMNS)
    away = middle[:2] - camera[:2]
    away = away / max(float(np.hypot(away[0], away[1])), 1e-9)
    right = np.array([away[1], -away[0]])
    centre = (a.centre - b.centre)[:2]
    ways = centre @ away, centre @ right, displacement[:2] @ away, displacement[:2] @ right
    return [float(way) for way in ways]
