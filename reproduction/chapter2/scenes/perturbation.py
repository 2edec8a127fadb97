"""Clouds changed on purpose: parts of a cloud, fewer points, an object segmented into two.

Each function takes a `LabelledCloud` and returns a new cloud with the same camera. Thesis: §2.4.1 discards points,
Figs 2.7 and 2.9 show wrong segmentations.
"""

from collections.abc import Collection
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud


def part_of(cloud: LabelledCloud, kept: NDArray[np.bool_]) -> LabelledCloud:
    """The points where `kept` ``(n,)`` is true."""
    colours = None if cloud.colours is None else cloud.colours[kept]
    return LabelledCloud(cloud.points[kept], cloud.labels[kept], colours, cloud.camera)


def only(cloud: LabelledCloud, objects: Collection[int]) -> LabelledCloud:
    """The cloud of some objects and the table."""
    return part_of(cloud, np.isin(cloud.labels, [TABLE, *objects]))


def without_table(cloud: LabelledCloud) -> LabelledCloud:
    """The points of the objects alone."""
    return part_of(cloud, cloud.labels > TABLE)


def fewer_points(cloud: LabelledCloud, discarded: float, rng: np.random.Generator) -> LabelledCloud:
    """Each point discarded with probability `discarded`, in [0, 1)."""
    return part_of(cloud, rng.random(len(cloud.points)) >= discarded)


def cut_object(
    cloud: LabelledCloud, label: int, normal: ArrayLike, through: ArrayLike
) -> tuple[LabelledCloud, int]:
    """The cloud with an object divided by a plane, and the new label: of the part that `normal` points to."""
    own = (cloud.labels == label) & (cloud.labels > TABLE)
    beyond = own & ((cloud.points - np.asarray(through, float)) @ np.asarray(normal, float) > 0)
    new = int(cloud.labels.max()) + 1
    return replace(cloud, labels=np.where(beyond, new, cloud.labels)), new
