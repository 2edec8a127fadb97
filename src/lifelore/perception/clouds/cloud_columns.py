"""Columns by name (`x`, `y`, `z`, `rgb`, `label`, …) to a `PointCloud`: the common step of all file formats."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.label_rule import ids_from_labels
from lifelore.perception.clouds.point_cloud import PointCloud

MAX_POINTS = 50_000_000
"""More points than this are refused before anything is allocated for them."""
LABEL_NAMES = ("label", "labels", "scalar_label", "object_id", "instance")
_COLOUR_NAMES = (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue"))
_PACKED_NAMES = ("rgba", "rgb")


def readable_fields(names: list[str]) -> list[str]:
    """The names among `names`, in any case, that `cloud_from_columns` reads; the others need not be decoded.

    Raises
    ------
    InputError
        A coordinate is missing.
    """
    lower = {name.lower() for name in names}
    missing = [name for name in "xyz" if name not in lower]
    if missing:
        raise InputError(f"has no field {' '.join(missing)}; its fields are {' '.join(names)[:200] or 'none'}")
    known = {"x", "y", "z", *LABEL_NAMES, *_PACKED_NAMES, *(name for three in _COLOUR_NAMES for name in three)}
    return [name for name in names if name.lower() in known]


def cast_to_header_type(column: NDArray[np.float64], dtype: np.dtype) -> NDArray:
    """A column read from text in the type of its header; integers stay floats where a value is NaN."""
    if dtype.kind != "f":
        return column.astype(np.int64) if (np.abs(column) <= 2.0**53).all() else column
    with np.errstate(over="ignore", under="ignore"):
        return column.astype(dtype)


def cloud_from_columns(
    columns: Mapping[str, NDArray],
    labels: str = "auto",
    grid: tuple[int, int] | None = None,
    camera: NDArray[np.float64] | None = None,
) -> PointCloud:
    """A cloud of the columns `x y z`, of colours where given, and of the first label column.

    Parameters
    ----------
    columns : name to (n,) numbers
        Names in any case. Colours as ``rgb``/``rgba`` (32 bits, packed) or ``red green blue`` (whole numbers
        0–255, or floats 0–1). Labels as any of `LABEL_NAMES`.
    labels : {"auto", "plain", "parts"}
        See `label_rule`.
    grid : (height, width), optional
        Of the image whose pixels the points are, row by row; a height or width of 1 means no image.
    camera : (3,), optional

    Raises
    ------
    InputError
        A coordinate is missing, or a column breaks its rule.
    """
    columns = {name.lower(): columns[name] for name in readable_fields(list(columns))}
    named = next((columns[name] for name in LABEL_NAMES if name in columns), None)
    return PointCloud(
        _points(columns),
        None if named is None else ids_from_labels(named, labels),
        _colours(columns),
        grid if grid and grid[0] > 1 and grid[1] > 1 else None,
        camera,
    )


def _points(columns: Mapping[str, NDArray]) -> NDArray[np.floating]:
    three = [columns[name] for name in "xyz"]
    # Sensors give float32, which halves the memory; doubles are kept, for maps far from their origin.
    small = all(column.dtype.itemsize <= 4 and column.dtype.kind == "f" for column in three)
    points = np.empty((len(three[0]), 3), np.float32 if small else np.float64)
    for axis, column in enumerate(three):
        points[:, axis] = column
    return points


def _colours(columns: Mapping[str, NDArray]) -> NDArray[np.uint8] | None:
    for name in _PACKED_NAMES:
        if name in columns:
            return unpack_colours(columns[name])
    for three in _COLOUR_NAMES:
        if all(name in columns for name in three):
            return colours_as_bytes(np.stack([columns[name] for name in three], axis=1))
    return None


def unpack_colours(packed: NDArray) -> NDArray[np.uint8]:
    """(n, 3) uint8 colours of 32 packed bits 0xAARRGGBB, as integers or as the bits of a float32."""
    if packed.dtype == np.float64:
        packed = packed.astype(np.float32)
    if packed.dtype.kind == "f":
        bits = np.ascontiguousarray(packed, np.float32).view(np.uint32)
    else:
        bits = packed.astype(np.uint32)
    return np.stack([(bits >> shift).astype(np.uint8) for shift in (16, 8, 0)], axis=1)


def colours_as_bytes(colours: NDArray) -> NDArray[np.uint8]:
    """(n, 3) uint8 of whole numbers 0–255, or of floats 0–1.

    Raises
    ------
    InputError
        A value lies outside.
    """
    if colours.dtype == np.uint8:
        return colours
    values = np.where(np.isnan(colours), 0.0, colours) if colours.dtype.kind == "f" else colours
    if colours.dtype.kind == "f" and values.max(initial=0.0) <= 1.0:
        values = values * 255.0
    if (values < 0).any() or (values > 255).any():
        raise InputError("colours must lie in 0 to 255, or as floats in 0 to 1")
    return np.rint(values).astype(np.uint8)
