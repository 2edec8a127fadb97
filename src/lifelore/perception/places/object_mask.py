"""The pixels of objects: masks as run lengths for JSON, and a label image of a scene."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud

_MOST = 2**16 - 1


def object_mask(cloud: LabelledCloud, label: int) -> dict[str, Any]:
    """Where an object is in the cloud that was read, as plain data.

    Returns
    -------
    dict
        ``{"mask": {"size": [height, width], "counts": […]}}`` of an organised cloud: the lengths of runs of
        pixels outside and inside in turn, column by column, first outside (COCO's uncompressed RLE). Else
        ``{"points": […]}``: rows of its points in the cloud; null where a point is a mean of several.
    """
    origin = cloud.origin
    rows = None if origin.rows is None else origin.rows[cloud.rows_of(label)]
    if origin.grid is None or rows is None:
        return {"points": None if rows is None else rows.tolist()}
    inside = np.zeros(origin.grid, bool)
    inside.flat[rows] = True
    return {"mask": {"size": list(origin.grid), "counts": run_lengths(inside)}}


def run_lengths(mask: NDArray[np.bool_]) -> list[int]:
    """Lengths of the runs of a (height, width) mask, column by column, the first of False.

    Examples
    --------
    >>> run_lengths(np.array([[True, False], [True, True]]))
    [0, 2, 1, 1]
    """
    flat = mask.ravel(order="F")
    changes = np.flatnonzero(np.diff(flat, prepend=False))
    return np.diff(changes, prepend=0, append=flat.size).tolist()


def label_image(cloud: LabelledCloud) -> NDArray[np.uint16]:
    """(height, width) numbers of the objects at their pixels: 0 nothing, 1 the table, 2 … objects.

    Raises
    ------
    InputError
        The cloud has no image, or a number is above 65535.
    """
    origin = cloud.origin
    if origin.grid is None or origin.rows is None:
        raise InputError(
            "a label image (--set masks_out=FILE) needs an organised cloud, and this one is not organised: ask for"
            " the numbers of the points instead (--set with_masks=true --json)"
        )
    if cloud.labels.max(initial=0) > _MOST:
        raise InputError(
            f"a label image (--set masks_out=FILE) holds numbers up to {_MOST}, got {cloud.labels.max()}"
        )
    image = np.zeros(origin.grid, np.uint16)
    image.flat[origin.rows] = cloud.labels
    return image
