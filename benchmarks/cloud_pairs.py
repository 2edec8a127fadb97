"""Pairs of touching clouds of any size for the separator's benchmark: real ones where they are, and drawn ones.

Fewer points are drawn without repetition. More come from interpolation: points halfway between neighbours within
`REACH`, then at a quarter and at three quarters; no noise is added, so the surfaces stay those of the camera.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.streams import stream
from reproduction.chapter2.scenes.real_scenes import real_scenes_folder

Cloud = NDArray[np.float64]

REAL = {"learn20": (20, 30), "learn22": (30, 40)}
"""Scene → labels of its nearest pair of objects."""
SMALL = {"learn22": (20, 30), "test45": (20, 40)}
"""As `REAL`: pairs of the size that most have in a scene of many objects."""
DRAWN = "drawn"
REACH = 0.006
"""Neighbours lie within so many metres: three pixels of the camera."""


def names() -> list[str]:
    """The drawn pair, and the real ones where LIFELORE_DATA has them."""
    return [DRAWN, *(REAL if real_scenes_folder() is not None else ())]


def cloud_pair(name: str, n: int) -> tuple[Cloud, Cloud]:
    """A pair with `n` points in all, shared as in the original."""
    parts = _drawn(n) if name == DRAWN else _real(name, REAL[name])
    total = sum(map(len, parts))
    first = round(n * len(parts[0]) / total)
    random = stream(0, "bench", "separator", name, str(n))
    return _resampled(parts[0], first, random), _resampled(parts[1], n - first, random)


def voxels(cloud: Cloud, edge: float = 0.003) -> Cloud:
    """The centroids of a cloud's voxels."""
    _, group = np.unique(np.floor(cloud / edge).astype(np.int64), axis=0, return_inverse=True)
    counts = np.bincount(group.ravel())
    return np.stack([np.bincount(group.ravel(), column) / counts for column in cloud.T], axis=1)


def small_pairs() -> dict[str, tuple[Cloud, Cloud]]:
    """Pairs as perception sees them, in voxels of 3 mm, by name."""
    found = {DRAWN: cloud_pair(DRAWN, 4000)}
    if real_scenes_folder() is not None:
        found |= {name: _real(name, labels) for name, labels in SMALL.items()}
    return {name: (voxels(first), voxels(second)) for name, (first, second) in found.items()}


@cache
def _real(name: str, labels: tuple[int, int]) -> tuple[Cloud, Cloud]:
    from pypcd4.pypcd4 import PointCloud

    folder = real_scenes_folder()
    assert folder is not None
    data = PointCloud.from_path(str(folder / f"{name}.pcd")).pc_data
    points = np.stack([data[axis] for axis in "xyz"], axis=1).astype(float)
    first, second = (points[(data["label"] == label) & np.isfinite(points[:, 2])] for label in labels)
    return first, second


def _drawn(n: int) -> tuple[Cloud, Cloud]:
    """A box on a larger box, 1.3 mm apart, with 0.5 mm noise: a camera's depth steps keep clouds apart."""
    random = stream(0, "bench", "separator", DRAWN)
    upper = _box(n // 2, (0.10, 0.12, 0.14), random) + np.array([0.03, 0.04, 0.0813])
    lower = _box(n - n // 2, (0.20, 0.22, 0.08), random)
    return upper + random.normal(0, 0.0005, upper.shape), lower + random.normal(0, 0.0005, lower.shape)


def _box(n: int, size: tuple[float, float, float], random: np.random.Generator) -> Cloud:
    """Points on a box's faces, by area."""
    areas = np.prod(size) / np.array(size)
    points, axis = random.random((n, 3)), random.choice(3, n, p=areas / areas.sum())
    points[np.arange(n), axis] = random.integers(0, 2, n)
    return points * size


def _resampled(cloud: Cloud, n: int, random: np.random.Generator) -> Cloud:
    if n <= len(cloud):
        return cloud[np.sort(random.choice(len(cloud), n, replace=False))]
    parts, wanted = [cloud], n - len(cloud)
    one, two = KDTree(cloud).query_pairs(REACH, output_type="ndarray").T
    for share in (0.5, 0.25, 0.75):
        between = cloud[one] * (1 - share) + cloud[two] * share
        if len(between) > wanted:
            between = between[np.sort(random.choice(len(between), wanted, replace=False))]
        parts.append(between)
        wanted -= len(between)
    return np.concatenate(parts)
