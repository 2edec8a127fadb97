"""`read_cloud`: a cloud from a PCD, PLY, npz or npy file, or from an array; every failure is one line."""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_scale import in_metres
from lifelore.perception.clouds.file_content import file_content, one_line_errors
from lifelore.perception.clouds.label_rule import check_rule, ids_from_labels
from lifelore.perception.clouds.npz_file import cloud_from_arrays, read_npy, read_npz
from lifelore.perception.clouds.pcd_file import read_pcd
from lifelore.perception.clouds.ply_file import read_ply
from lifelore.perception.clouds.point_cloud import PointCloud

KINDS = "a PCD, PLY, npz or npy file"
_READERS: dict[str, Callable[[bytes, str], PointCloud]] = {
    ".pcd": read_pcd, ".ply": read_ply, ".npz": read_npz, ".npy": read_npy,
}  # fmt: skip
IMAGES = (b"\x89PNG", b"\xff\xd8\xff", b"II*\0", b"MM\0*")
"""First bytes of PNG, JPEG and TIFF files."""
_BAGS = (b"#ROSBAG", b"\x89MCAP0", b"SQLite format 3")


def read_cloud(source: str | os.PathLike[str] | NDArray, *, units: str = "m", labels: str = "auto") -> PointCloud:
    """Read a cloud.

    Parameters
    ----------
    source : path or (n, 3), (n, 4), (rows, columns, 3) array
        A PCD, PLY, npz or npy file, recognised by its content, then by its suffix; or the points, with labels
        as an optional fourth column.
    units : {"m", "cm", "mm", "inch"}
        Of the coordinates. A cloud in metres that looks like other units is refused, see `cloud_scale`.
    labels : {"auto", "plain", "parts"}
        How labels become object numbers, see `label_rule`.

    Returns
    -------
    PointCloud
        In metres, in the sensor's frame, with at least one finite point; points that were not measured are
        NaN. ``from_parts`` is True where the labels were read as parts.

    Raises
    ------
    InputError
        The file is missing, too large, of no known kind, damaged, empty, or breaks a rule; the message names
        it.

    Examples
    --------
    >>> read_cloud(np.random.default_rng(0).random((100, 3)), units="m").points.shape
    (100, 3)
    """
    check_rule(labels)
    if isinstance(source, np.ndarray):
        return one_line_errors(
            "array",
            "a cloud",
            lambda: _with_objects(in_metres(cloud_from_arrays(source, rule="plain"), units), labels),
        )
    if not isinstance(source, str | os.PathLike):
        raise InputError(f"source must be a path or an array of points, got {type(source).__name__}")
    path = Path(source)
    return one_line_errors(str(path), "a cloud", lambda: _with_objects(in_metres(_decoded(path), units), labels))


def _decoded(path: Path) -> PointCloud:
    content = file_content(path, KINDS)
    return _reader(path, content)(content, "plain")


def _with_objects(cloud: PointCloud, rule: str) -> PointCloud:
    """The cloud with its labels as object numbers; ``from_parts`` where labels were merged."""
    if cloud.labels is None:
        return cloud
    ids = ids_from_labels(cloud.labels, rule)
    return replace(cloud, labels=ids, from_parts=not np.array_equal(ids, cloud.labels))


def _reader(path: Path, content: bytes) -> Callable[[bytes, str], PointCloud]:
    if content.startswith((b"ply\n", b"ply\r")):
        return read_ply
    if content.startswith(b"PK\x03\x04"):
        return read_npz
    if content.startswith(b"\x93NUMPY"):
        return read_npy
    if content.startswith((b"# .PCD", b"VERSION", b"FIELDS")):
        return read_pcd
    if content.startswith(_BAGS):
        raise InputError("is a rosbag, not a cloud; pass the .bag or .mcap file, or the bag's folder (extra ros)")
    if content.startswith(IMAGES):
        raise InputError(
            "is an image, not a cloud; a depth image needs the camera's intrinsics (--intrinsics FILE)"
        )
    if path.suffix.lower() in _READERS and content:
        return _READERS[path.suffix.lower()]
    raise InputError(f"is {'no cloud we know' if content else 'empty'}; give {KINDS}")
