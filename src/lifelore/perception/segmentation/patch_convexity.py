"""How surely two neighbouring patches belong to one object, by the angle and the step between them.

After Stein et al. (2014): the surface of an object is mostly convex, and objects meet in concave creases. Where an
object ends above another one, the surface steps down.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.segmentation.supervoxels import Supervoxels

_ANGLES = (-40.0, -15.0, 0.0, 30.0, 90.0)
"""Degrees, concave below 0. The knots of `evidence`; a concave angle below 15° counts for one object, because
normals are noisy and surfaces such as the inside of a bowl bend a little."""
_LOG_ODDS = (-5.0, 0.0, 5.0, 3.0, 1.0)
"""Log odds of one object at the knots: rounded from logistic regressions on simulated and on real scenes."""

_STEP = 9.0
"""Log odds against one object for each length of a voxel by which the surface steps. Logistic regressions give 6
to 9; more cuts noisy surfaces."""

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


def steps(patches: Supervoxels) -> NDArray[np.float64]:
    """(e,) metres by which the surface steps between the patches of each pair.

    At a step one patch lies above the plane of the other, and this one below the plane of the first; the smaller
    of the two distances counts. At a ridge each lies below the other's plane, at a crease above: no step. Nor is
    there one where the normals differ by more than 90°: of a face seen at a grazing angle, the side is a guess.
    """
    first, second = patches.pairs.T
    apart = patches.middles[first] - patches.middles[second]
    above, below = (np.einsum("ij,ij->i", patches.normals[end], apart) for end in (first, second))
    alike = np.einsum("ij,ij->i", patches.normals[first], patches.normals[second]) > 0
    return np.where(alike & (above * below > 0), np.minimum(np.abs(above), np.abs(below)), 0.0)


def evidence(angles: NDArray[np.float64], steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """(e,) log odds that two patches belong to one object, −5 to 5, by their angle and their step in voxels."""
    return np.maximum(np.interp(angles, _ANGLES, _LOG_ODDS) - _STEP * steps, _LOG_ODDS[0])
