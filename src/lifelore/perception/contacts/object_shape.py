"""`ObjectShape`: foot, top and outline of an object's visible points, robust to stray ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

N_DIRECTIONS = 16
SAMPLE = 300
"""Number of points on which shares are measured: accurate to about 0.03; more cost time."""
STRAY = 0.01
"""Share of the points that may lie outside at each end."""
LOW_BAND = 0.02
"""Metres above the foot within which a point counts as low."""

_angle = 2 * np.pi * np.arange(N_DIRECTIONS) / N_DIRECTIONS
DIRECTIONS = np.stack([np.cos(_angle), np.sin(_angle)])
"""Horizontal unit vectors all round, ``(2, N_DIRECTIONS)``."""


@dataclass(frozen=True, eq=False)
class ObjectShape:
    """Foot, top, centre, width and outline of an object, metres.

    Parameters
    ----------
    foot, top : float
        Heights below and above which a share `STRAY` of the points lies.
    centre : (3,) float64
        Middle of the box without stray points.
    width : float
        Greatest horizontal breadth.
    outline : (N_DIRECTIONS,) float64
        Extent of the object along each of `DIRECTIONS`.
    sample : (m, 3) float64
        At most `SAMPLE` of its points, evenly spaced in order.
    """

    foot: float
    top: float
    centre: NDArray[np.float64]
    width: float
    outline: NDArray[np.float64]
    sample: NDArray[np.float64]

    @property
    def height(self) -> float:
        """From foot to top, at least a millimetre."""
        return max(self.top - self.foot, 1e-3)

    def over(self, other: "ObjectShape") -> NDArray[np.bool_]:
        """Whether each sample point lies within the outline of `other` seen from above, (m,)."""
        return np.all(self.sample[:, :2] @ DIRECTIONS <= other.outline, axis=1)

    @property
    def low(self) -> NDArray[np.bool_]:
        """Whether each sample point lies within `LOW_BAND` of the foot, (m,)."""
        return self.sample[:, 2] <= self.foot + LOW_BAND


def shape_of(points: NDArray[np.float64]) -> ObjectShape:
    """The shape of ``(n, 3)`` points, n ≥ 1."""
    sample = points[:: -(-len(points) // SAMPLE)]
    rows = [round(share * (len(points) - 1)) for share in (STRAY, 1 - STRAY)]
    low, high = np.partition(points, rows, axis=0)[rows]
    reach = np.sort(points[:: -(-len(points) // (4 * SAMPLE)), :2] @ DIRECTIONS, axis=0)
    outline = reach[-1 - int(STRAY * len(reach))]
    half = N_DIRECTIONS // 2
    return ObjectShape(
        foot=float(low[2]),
        top=float(high[2]),
        centre=(low + high) / 2,
        width=float((outline[:half] + outline[half:]).max()),
        outline=outline,
        sample=sample,
    )
