"""One object wrongly segmented into two: its points are divided by a plane, as thesis Figs 2.7 and 2.9 have it."""

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud


def cut_object(
    cloud: LabelledCloud, label: int, normal: ArrayLike, through: ArrayLike
) -> tuple[LabelledCloud, int]:
    """The cloud with an object in two, and the new label: that of the part on the side `normal` points to.

    Raises
    ------
    InputError
        The cloud has no such object, or the plane leaves one side empty.
    """
    own = (cloud.labels == label) & (cloud.labels > TABLE)
    beyond = own & ((cloud.points - np.asarray(through, float)) @ np.asarray(normal, float) > 0)
    if not beyond.any() or beyond.sum() == own.sum():
        raise InputError(
            f"the plane must divide object {label}, of whose {own.sum()} points it parts {beyond.sum()}"
        )
    new = int(cloud.labels.max()) + 1
    labels = np.where(beyond, new, cloud.labels)
    return LabelledCloud(cloud.points, labels, cloud.colours, cloud.camera), new
