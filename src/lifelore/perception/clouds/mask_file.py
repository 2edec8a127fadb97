"""Labels of a cloud's points from the masks of any instance segmenter: a label image, or a stack of masks."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED
from lifelore.perception.clouds.depth_file import opened_image
from lifelore.perception.clouds.file_content import file_content, one_line_errors
from lifelore.perception.clouds.label_rule import MAX_OBJECTS, ids_from_labels
from lifelore.perception.clouds.npz_file import array_of_npy, arrays_of_npz
from lifelore.perception.clouds.point_cloud import PointCloud

MASK_KINDS = "a PNG label image of 8 or 16 bits, or an npz or npy file with labels or masks"
NO_MASK = 0
"""Value of a label image where there is no mask."""


def read_masks(path: str | os.PathLike[str], cloud: PointCloud, table_mask: int | None = None) -> PointCloud:
    """The cloud with labels from a file of masks; labels that it had are replaced.

    Parameters
    ----------
    path : path
        A PNG with a single channel (8 or 16 bits, or a palette's numbers), whose values are numbers of masks; or
        an npz file with an array ``labels`` of such numbers ((height, width), or (n,) in the order of the points)
        or an array ``masks`` ((k, height, width) bool); or either array as npy.
    cloud : PointCloud
        Organised, except for labels of shape (n,).
    table_mask : int, optional
        Number of the table's mask. Masks of a stack are numbered from 1.

    Returns
    -------
    PointCloud
        Mask number N is object N + 1, the table's mask is the table (1), and the rest is 0.

    Raises
    ------
    InputError
        The file is missing or damaged, its size differs from the cloud's, the cloud is not organised, there is no
        mask, or no mask with the number of the table.
    """

    def labelled() -> PointCloud:
        numbers = _of_points(_mask_numbers(Path(path)), cloud)
        return replace(cloud, labels=_labels(numbers, table_mask), from_parts=False)

    return one_line_errors(str(path), MASK_KINDS, labelled)


def _mask_numbers(path: Path) -> NDArray[np.int64]:
    """(height, width) or (n,) numbers of masks."""
    content = file_content(path, MASK_KINDS)
    if content.startswith(b"\x89PNG"):
        image = opened_image(content)
        if image.mode not in ("1", "L", "P") and not image.mode.startswith("I"):
            raise InputError(
                f"is an image of mode {image.mode}, but a label image has a single channel; give {MASK_KINDS}"
            )
        return np.asarray(image).astype(np.int64)
    if content.startswith(b"PK\x03\x04"):
        arrays, held = arrays_of_npz(content, ("labels", "masks"))
        if len(arrays) != 1:
            raise InputError(
                f"must have either an array 'labels' or an array 'masks'; its arrays are {held or 'none'}"
            )
        array = next(iter(arrays.values()))
    elif content.startswith(b"\x93NUMPY"):
        array = array_of_npy(content, "masks")
    else:
        raise InputError(f"holds no masks; give {MASK_KINDS}")
    if array.ndim == 3:
        return numbers_of_stack(array)
    if array.ndim not in (1, 2):
        raise InputError(f"masks must have shape (height, width), (n,) or (k, height, width), got {array.shape}")
    return ids_from_labels(array.reshape(-1), "plain").reshape(array.shape)


def numbers_of_stack(masks: NDArray) -> NDArray[np.int64]:
    """(height, width) number of the mask of each pixel, from 1; 0 without.

    Where masks overlap, the smaller has the pixel: the part of an object that lies before another is cut out
    of the other. Equal masks go to the first.

    Parameters
    ----------
    masks : (k, height, width) bool, or 0 and 1

    Raises
    ------
    InputError
        A value is neither 0 nor 1.

    Examples
    --------
    >>> numbers_of_stack(np.array([[[1, 1, 1, 0]], [[0, 1, 0, 0]]])).tolist()
    [[1, 2, 1, 0]]
    """
    if not np.isin(masks, (0, 1)).all():
        raise InputError("masks of a stack (k, height, width) must be true or false")
    if len(masks) > MAX_OBJECTS:
        raise InputError(f"holds {len(masks)} masks where at most {MAX_OBJECTS} are possible")
    numbers = np.full(masks.shape[1:], NO_MASK, np.int64)
    areas = np.count_nonzero(masks, axis=(1, 2))
    # Painted from the largest to the smallest, and of equal ones the first last.
    for place in np.lexsort((-np.arange(len(masks)), -areas)).tolist():
        numbers[masks[place].astype(bool)] = place + 1
    return numbers


def _of_points(numbers: NDArray[np.int64], cloud: PointCloud) -> NDArray[np.int64]:
    """(n,) number of the mask of each point."""
    n = len(cloud.points)
    if numbers.ndim == 1:
        if len(numbers) != n:
            raise InputError(f"holds {len(numbers)} labels, but the cloud {n} points: give a label for each point")
        return numbers
    size = f"{numbers.shape[1]} × {numbers.shape[0]} pixels"
    if cloud.grid is None:
        raise InputError(
            f"holds masks of {size}, but the cloud is not organised ({n} points in no image): give an organised"
            " cloud or a depth image, or labels of shape (n,)"
        )
    if numbers.shape != cloud.grid:
        raise InputError(
            f"holds masks of {size}, but the cloud has {cloud.grid[1]} × {cloud.grid[0]}: give masks of"
            " the same size"
        )
    flat = numbers.reshape(-1)
    return flat if cloud.source_rows is None else flat[cloud.source_rows]


def _labels(numbers: NDArray[np.int64], table_mask: int | None) -> NDArray[np.int64]:
    used = np.unique(numbers[numbers != NO_MASK])
    if len(used) == 0:
        raise InputError("holds no mask over any point: all labels are 0")
    if len(used) > MAX_OBJECTS:
        raise InputError(f"holds {len(used)} masks where at most {MAX_OBJECTS} are possible")
    labels = np.where(numbers == NO_MASK, UNLABELLED, numbers + 1)
    if table_mask is not None:
        if table_mask not in used:
            raise InputError(f"holds no mask {table_mask} for the table; its masks are {_listed(used)}")
        labels[numbers == table_mask] = TABLE
    return labels


def _listed(used: NDArray[np.int64]) -> str:
    return ", ".join(map(str, used[:10].tolist())) + (", …" if len(used) > 10 else "")
