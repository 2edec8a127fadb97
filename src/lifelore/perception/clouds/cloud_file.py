"""`read_cloud`: a cloud from a PCD, PLY, npz or npy file, or from an array; every failure is one line."""

import os
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_scale import in_metres
from lifelore.perception.clouds.label_rule import check_rule, ids_from_labels
from lifelore.perception.clouds.npz_file import cloud_from_arrays, read_npy, read_npz
from lifelore.perception.clouds.pcd_file import read_pcd
from lifelore.perception.clouds.ply_file import read_ply
from lifelore.perception.clouds.point_cloud import PointCloud

MAX_FILE_BYTES = 4 * 2**30
_READERS: dict[str, Callable[[bytes, str], PointCloud]] = {
    ".pcd": read_pcd, ".ply": read_ply, ".npz": read_npz, ".npy": read_npy,
}  # fmt: skip
_BAGS = (b"#ROSBAG", b"\x89MCAP0", b"SQLite format 3")


def read_cloud(source: str | os.PathLike[str] | NDArray, *, units: str = "m", labels: str = "auto") -> PointCloud:
    """Read a cloud.

    Parameters
    ----------
    source : path or (n, 3), (n, 4), (rows, columns, 3) array
        A PCD, PLY, npz or npy file, recognised by its content, then by its suffix; or the points, with labels
        as an optional fourth column.
    units : {"m", "mm"}
        Of the coordinates. A cloud in metres that looks like millimetres is refused, see `cloud_scale`.
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
    """
    check_rule(labels)
    if isinstance(source, np.ndarray):
        return _one_line_errors(
            "array",
            lambda: _with_objects(in_metres(cloud_from_arrays(source, rule="plain"), units), labels),
        )
    path = Path(source)
    return _one_line_errors(str(path), lambda: _with_objects(in_metres(_decoded(path), units), labels))


def _decoded(path: Path) -> PointCloud:
    content = _content(path)
    return _reader(path, content)(content, "plain")


def _with_objects(cloud: PointCloud, rule: str) -> PointCloud:
    """The cloud with its labels as object numbers; ``from_parts`` where labels were merged."""
    if cloud.labels is None:
        return cloud
    ids = ids_from_labels(cloud.labels, rule)
    return replace(cloud, labels=ids, from_parts=not np.array_equal(ids, cloud.labels))


def _one_line_errors(name: str, read: Callable[[], PointCloud]) -> PointCloud:
    try:
        # A damaged number may overflow in between; later checks judge the result.
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return read()
    except InputError as error:
        raise InputError(f"{name}: {_one_line(str(error))}") from None
    except MemoryError:
        raise InputError(f"{name}: does not fit into memory; crop or thin the cloud") from None
    except Exception as error:  # a damaged file can fail anywhere in its decoder
        raise InputError(f"{name}: is damaged or not a cloud ({_one_line(str(error))}); write it again") from error


def _one_line(text: str) -> str:
    # A damaged file may hold any characters, including control characters of a terminal.
    return "".join(letter if letter.isprintable() else "?" for letter in " ".join(text.split()))[:300]


def _content(path: Path) -> bytes:
    try:
        # Reading a pipe or a device could block for ever.
        if path.exists() and not path.is_file():
            raise InputError("is no file; give a PCD, PLY, npz or npy file")
        if path.stat().st_size > MAX_FILE_BYTES:
            raise InputError(f"is larger than {MAX_FILE_BYTES // 2**30} GiB; crop or thin the cloud")
        return path.read_bytes()
    except FileNotFoundError:
        raise InputError("no such file") from None
    except (OSError, ValueError) as error:
        raise InputError(f"cannot be read ({error})") from None


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
    if path.suffix.lower() in _READERS and content:
        return _READERS[path.suffix.lower()]
    raise InputError(f"is {'no cloud we know' if content else 'empty'}; give a PCD, PLY, npz or npy file")
