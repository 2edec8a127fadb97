"""Segmentation by local convexity: surfaces are cut where they meet in a crease.

After Stein et al. (2014), locally convex connected patches (LCCP): supervoxels, the angle at each of their
borders, and regions of patches that bend outwards. Here regions grow by the mean evidence along their whole
border, and cuts from several lattices of supervoxels vote.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.segmentation.cut_confidence import CutCloud, cut_confidence, labels_by_size
from lifelore.perception.segmentation.free_space import View, view_from
from lifelore.perception.segmentation.hollow_objects import hollow_pairs
from lifelore.perception.segmentation.parted_objects import parted_pairs
from lifelore.perception.segmentation.patch_convexity import beyond_bend, evidence, signed_angles, steps
from lifelore.perception.segmentation.patch_merging import absorbed, merged
from lifelore.perception.segmentation.plane import NEAR
from lifelore.perception.segmentation.range_noise import band
from lifelore.perception.segmentation.supervoxels import Supervoxels, step_costs, supervoxels
from lifelore.perception.segmentation.surface_voxels import SurfaceVoxels, surface_voxels

VOXEL = 0.005
"""Metres, where the noise is that of the near range; voxels and patches grow with the noise of the objects' median
range (`range_noise`). Less resolves smaller objects, more tolerates more noise."""
NOISIEST = 4.0
"""Limit of that growth, reached at a range of 2.6 m; larger patches would be whole objects."""
PATCH = 0.020
"""Metres between the seeds of patches: about half the smallest object."""
FRAGMENT = 150
"""Voxels of that size, 37 cm² of surface; a smaller region joins the neighbour of the longest border. Less leaves
slivers at creases, more swallows small objects that touch others."""
LEAST_SURE = 0.4
"""Probability of a true object (`cut_confidence`); a less sure region joins the neighbour of the longest border.
More removes more false objects, and swallows small true ones."""
_STARTS = (0.0, 1 / 3, 2 / 3)
"""Where the lattices of seeds begin. One cut depends on where its seeds fall, by which a crease of few patches is
found or missed; of three, the one that agrees most with the others is taken. More cost time, and gain little."""
_SAME = 0.98
"""Agreement of the first two cuts from which no third is made; it costs a tenth of the time of a scene."""
_MOST_VOXELS = 100_000
_SPARSE = 3 * VOXEL
"""Size to which the voxels of sparse points grow."""


def convex_objects(
    points: NDArray[np.float64],
    camera: NDArray[np.float64] | None,
    min_area: float,
    seen: NDArray[np.float64] | None = None,
) -> CutCloud:
    """Labels 2 for the object of the largest surface, 3 for the next, …, 0 for noise; with confidences.

    Parameters
    ----------
    points : (n, 3) float64
        Metres, finite, z up; above the table.
    camera : (3,) float64, optional
        Position of the camera. Without it, the outer side of a surface is guessed.
    min_area : float
        Square metres of surface below which a region is noise.
    seen : (m, 3) float64, optional
        All points that the camera sees, those of the table too; default: `points`.
    """
    if len(points) == 0:
        return CutCloud(np.empty(0, np.int64))
    # Voxels of less than the noise would be layers of a surface, and not its surface.
    noisier = min(float(np.median(band(points, camera))) / NEAR, NOISIEST)
    surface = surface_voxels(points, camera, VOXEL * noisier, _MOST_VOXELS, _SPARSE)
    view = view_from(camera, points if seen is None else seen)
    spacing = PATCH * surface.size / VOXEL
    costs = step_costs(surface, spacing)
    cuts: list[CutCloud] = []
    for start in _STARTS:
        cuts.append(_cut(surface, supervoxels(surface, costs, spacing, start), view, min_area))
        if len(cuts) == 2 and agreement(cuts[0].labels, cuts[1].labels) >= _SAME:
            break
    cut = most_agreed(cuts)
    return replace(cut, labels=cut.labels[surface.inverse])


def _cut(
    surface: SurfaceVoxels,
    patches: Supervoxels,
    view: View,
    min_area: float,
) -> CutCloud:
    """Labels of the voxels of a surface, whose patches join into objects."""
    odds = evidence(beyond_bend(patches, signed_angles(patches)), steps(patches) / surface.size)
    fragment = round(FRAGMENT * (VOXEL / surface.size) ** 2)
    regions = merged(patches, odds, fragment, surface.size, view)
    regions = absorbed(
        regions, patches.pairs, patches.borders, lambda own: _below(fragment, _voxels(patches, own))
    )
    pairs = [
        *hollow_pairs(surface, patches, regions, fragment),
        *parted_pairs(patches, regions, fragment, view),
    ]
    joined = connected_parts(np.array(pairs, np.int64).reshape(-1, 2), int(regions.max()) + 1)
    regions = joined[regions]
    n_cut = int((_voxels(patches, regions) * surface.size**2 >= min_area).sum())
    regions = absorbed(
        regions,
        patches.pairs,
        patches.borders,
        lambda own: _below(LEAST_SURE, cut_confidence(patches, odds, own)),
    )
    label = labels_by_size(_voxels(patches, regions) * surface.size**2, min_area)
    sure = cut_confidence(patches, odds, regions)
    confidence = {int(label[region]): float(sure[region]) for region in np.argsort(label) if label[region]}
    return CutCloud(label[regions][patches.of_voxel], confidence, n_cut)


def most_agreed(cuts: Sequence[CutCloud]) -> CutCloud:
    """The cut that agrees most with all others; of equal ones the first."""
    return max(cuts, key=lambda cut: sum(round(agreement(cut.labels, other.labels), 9) for other in cuts))


def agreement(first: NDArray[np.int64], second: NDArray[np.int64]) -> float:
    """Mean intersection over union, 0 to 1, of each point's object in one cut with its best match in the other.

    Examples
    --------
    >>> agreement(np.array([2, 2, 3, 3]), np.array([3, 3, 2, 2])), agreement(np.array([2, 2]), np.array([2, 3]))
    (1.0, 0.5)
    """
    both = np.zeros((first.max() + 1, second.max() + 1))
    np.add.at(both, (first, second), 1.0)
    sizes = both.sum(axis=1, keepdims=True), both.sum(axis=0, keepdims=True)
    shares = both / np.maximum(sizes[0] + sizes[1] - both, 1.0)
    mine, theirs = (shares.max(axis=axis, keepdims=True) for axis in (1, 0))
    return float(((mine * sizes[0]).sum() + (theirs * sizes[1]).sum()) / (2 * len(first)))


def _voxels(patches: Supervoxels, regions: NDArray[np.int64]) -> NDArray[np.float64]:
    """(r,) number of voxels of each region."""
    return np.bincount(regions, patches.counts).astype(np.float64)


def _below(limit: float, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The values below a limit; infinity in place of the others."""
    return np.where(values < limit, values, np.inf)
