"""NumPy files: ``.npz`` with `points`, optional `labels`, `colours`, `camera`, and ``.npy`` with points."""

import zipfile
from io import BytesIO
from typing import IO

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_columns import MAX_POINTS, colours_as_bytes
from lifelore.perception.clouds.label_rule import ids_from_labels
from lifelore.perception.clouds.point_cloud import PointCloud

_NAMES = ("points", "labels", "colours", "colors", "camera")


def read_npz(content: bytes, labels: str = "auto") -> PointCloud:
    """The cloud in the bytes of an npz file with arrays `points`, and optionally `labels`, `colours`, `camera`.

    Raises
    ------
    InputError
        The archive is damaged, `points` is missing, or an array breaks its rule.
    """
    arrays, held = arrays_of_npz(content, _NAMES)
    if "points" not in arrays:
        raise InputError(f"has no array 'points'; its arrays are {held or 'none'}")
    return cloud_from_arrays(
        arrays["points"],
        arrays.get("labels"),
        arrays.get("colours", arrays.get("colors")),
        arrays.get("camera"),
        labels,
    )


def read_npy(content: bytes, labels: str = "auto") -> PointCloud:
    """The cloud in the bytes of an npy file; see `cloud_from_arrays` for its shapes."""
    return cloud_from_arrays(array_of_npy(content, "points"), rule=labels)


def cloud_from_arrays(
    points: ArrayLike,
    labels: ArrayLike | None = None,
    colours: ArrayLike | None = None,
    camera: ArrayLike | None = None,
    rule: str = "auto",
) -> PointCloud:
    """A cloud of arrays.

    Parameters
    ----------
    points : (n, 3) or (rows, columns, 3) numbers
        Three axes make an organised cloud, with `PointCloud.grid`. With a fourth column for labels where
        `labels` is not given.
    labels : (n,) or (rows, columns) numbers, optional
        Turned to ids by `rule`, see `label_rule`.
    colours : (n, 3) or (rows, columns, 3), optional
        Whole numbers 0–255 or floats 0–1.
    camera : (3,), optional
        Where the camera stands, in the frame and the unit of the points; finite.

    Raises
    ------
    InputError
        A shape or value breaks its rule.
    """
    table = np.asarray(points)
    if table.dtype.kind not in "fiu" or table.ndim not in (2, 3) or table.shape[-1] not in (3, 4):
        raise InputError(
            f"points must be numbers of shape (n, 3) or (rows, columns, 3), got {table.dtype} {table.shape}"
        )
    grid = (table.shape[0], table.shape[1]) if table.ndim == 3 else None
    table = table.reshape(-1, table.shape[-1])
    if labels is None and table.shape[1] == 4:
        labels = table[:, 3]
    kind = table.dtype if table.dtype in (np.float32, np.float64) else np.float64
    return PointCloud(
        np.ascontiguousarray(table[:, :3], kind),
        None if labels is None else ids_from_labels(np.asarray(labels).reshape(-1), rule),
        None if colours is None else colours_as_bytes(np.asarray(colours).reshape(-1, 3)),
        grid,
        None if camera is None else np.asarray(camera, np.float64),
    )


def array_of_npy(content: bytes, name: str) -> NDArray:
    """The array in the bytes of an npy file; `name` is for the messages.

    Raises
    ------
    InputError
        It holds no numbers, or its header contradicts its size.
    """
    return _checked(BytesIO(content), len(content), name)


def arrays_of_npz(content: bytes, names: tuple[str, ...]) -> tuple[dict[str, NDArray], str]:
    """The arrays of these names in the bytes of an npz file, and the names of all its arrays for a message.

    Raises
    ------
    InputError
        An array holds no numbers, or its header contradicts its size.
    """
    with zipfile.ZipFile(BytesIO(content)) as archive:
        held = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
        return {name: _array(archive, held[name], name) for name in names if name in held}, ", ".join(held)[:200]


def _array(archive: zipfile.ZipFile, info: zipfile.ZipInfo, name: str) -> NDArray:
    with archive.open(info) as member:
        return _checked(member, info.file_size, name)


def _checked(file: IO[bytes], size: int, name: str) -> NDArray:
    """The array in `file`, once its header agrees with its size in bytes."""
    version = np.lib.format.read_magic(file)
    header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, fortran, dtype = header(file)
    if dtype.kind not in "fiub":
        raise InputError(f"array {name!r} must hold numbers, got {dtype}")
    n = int(np.prod([int(side) for side in shape], dtype=object))
    if n > 4 * MAX_POINTS or n * dtype.itemsize > size:
        raise InputError(
            f"array {name!r} says shape {shape}, more than the file holds or than {MAX_POINTS} points"
        )
    data = file.read(n * dtype.itemsize)
    if len(data) != n * dtype.itemsize:
        raise InputError(f"array {name!r} is cut off")
    return np.frombuffer(data, dtype).reshape(shape, order="F" if fortran else "C")
