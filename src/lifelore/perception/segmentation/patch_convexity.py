"""How surely two neighbouring patches belong to one object, by the angle at which they meet.

After Stein et al. (2014): the surface of an object is mostly convex, and objects meet in concave creases.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.segmentation.supervoxels import Supervoxels

_ANGLES = (-40.0, -15.0, 0.0, 30.0, 90.0)
"""Degrees, concave below 0. The knots of `evidence`; a concave angle below 15° counts for one object, because
normals are noisy and surfaces such as the inside of a bowl bend a little."""
_LOG_ODDS = (-5.0, 0.0, 5.0, 3.0, 1.0)
"""Log odds of one object at the knots: rounded from logistic regressions on simulated and on real scenes."""

_MOST_BEND = 25.0
"""Degrees from one patch to the next, 2 cm on: the inside of a bowl of 5 cm radius."""


def signed_angles(patches: Supervoxels) -> NDArray[np.float64]:
    """(e,) degrees between the normals of each pair, in −180 to 180: positive where the two form a ridge, negative
    where they form a crease."""
    first, second = patches.pairs.T
    apart = patches.middles[first] - patches.middles[second]
    cosine = np.einsum("ij,ij->i", patches.normals[first], patches.normals[second])
    angle = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    ridge = np.einsum("ij,ij->i", patches.normals[first] - patches.normals[second], apart) > 0
    return np.where(ridge, angle, -angle)


def beyond_bend(patches: Supervoxels, angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """(e,) degrees: angles less the concave bend of the surface on both sides.

    The inside of a bowl bends inwards everywhere; where two objects meet, the surface bends in the crease alone.
    The bend of a patch is the median of its angles, weighed by the length of the borders. The less concave of the
    two counts, unless it is more than `_MOST_BEND`: such a patch lies in a crease.
    """
    ends, again = patches.pairs.T.reshape(-1), np.concatenate([angles, angles])
    weights = np.concatenate([patches.borders, patches.borders]).astype(float)
    order = np.lexsort((again, ends))
    ends, again, weights = ends[order], again[order], weights[order]
    total = np.bincount(ends, weights, minlength=len(patches.counts))
    upto = np.cumsum(weights)
    before = np.concatenate([[0.0], np.cumsum(total)])[ends]
    half = np.flatnonzero(upto - before >= total[ends] / 2)
    bend = np.zeros(len(patches.counts))
    first = np.unique(ends[half], return_index=True)
    bend[first[0]] = again[half[first[1]]]
    shared = np.maximum(*bend[patches.pairs].T)
    return np.where((shared < 0) & (shared >= -_MOST_BEND), angles - shared, angles)


def evidence(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """(e,) log odds that two patches that meet at these angles belong to one object, −5 to 5."""
    return np.interp(angles, _ANGLES, _LOG_ODDS)
