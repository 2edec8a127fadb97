"""Poses of cameras from a file: 4 × 4 matrices in JSON, npz or npy, or lines of the TUM format."""

import json
import os
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.file_content import file_content, one_line_errors
from lifelore.perception.clouds.npz_file import array_of_npy, arrays_of_npz

POSE_KINDS = "a JSON, npz or npy file of 4 × 4 matrices, or lines of the TUM format (time x y z qx qy qz qw)"
_LIMIT = 2**24
_RIGID = 1e-3
"""Largest error of a rotation's entries; more is a scale, a shear or a mirror."""
_COLUMNS = 8


def read_poses(path: str | os.PathLike[str], n: int) -> NDArray[np.float64]:
    """Read the poses of `n` views.

    Parameters
    ----------
    path : path
        A JSON list of 4 × 4 matrices, or an object with such a list under ``poses``; an npz file with an array
        ``poses`` of shape (n, 4, 4), or the array as npy; or a text with a line ``time x y z qx qy qz qw`` for
        each view (TUM), where ``#`` begins a comment. Metres. Each pose maps points of a view's frame to a frame
        that all share (camera to world).
    n : int
        Number of views; the poses stand in their order.

    Returns
    -------
    (n, 4, 4) float64
        Rigid motions: rotation matrices within rounding, last row 0 0 0 1.

    Raises
    ------
    InputError
        The file is missing or damaged, holds another number of poses, or a pose is no rigid motion.
    """

    def poses() -> NDArray[np.float64]:
        found = _matrices(Path(path))
        if found.shape != (n, 4, 4):
            raise InputError(
                f"must hold {n} poses of 4 × 4, one for each cloud in their order, got shape {found.shape}"
            )
        return np.stack([_rigid(matrix, number) for number, matrix in enumerate(found)])

    return one_line_errors(str(path), POSE_KINDS, poses)


def _matrices(path: Path) -> NDArray[np.float64]:
    content = file_content(path, POSE_KINDS, _LIMIT)
    if content.startswith(b"PK\x03\x04"):
        arrays, held = arrays_of_npz(content, ("poses",))
        if "poses" not in arrays:
            raise InputError(f"has no array 'poses'; its arrays are {held or 'none'}")
        return arrays["poses"].astype(np.float64)
    if content.startswith(b"\x93NUMPY"):
        return array_of_npy(content, "poses").astype(np.float64)
    if content.lstrip()[:1] in (b"[", b"{"):
        values = json.loads(content)
        values = values.get("poses") if isinstance(values, dict) else values
        return np.array(values, np.float64)
    rows = np.loadtxt(BytesIO(content), np.float64, ndmin=2)
    if rows.shape[1] != _COLUMNS:
        raise InputError(
            f"has lines of {rows.shape[1]} numbers, but a pose has {_COLUMNS}: time x y z qx qy qz qw"
        )
    return np.stack([_from_quaternion(row) for row in rows])


def _from_quaternion(row: NDArray[np.float64]) -> NDArray[np.float64]:
    from scipy.spatial.transform import Rotation

    if not abs(np.linalg.norm(row[4:]) - 1) <= 0.01:
        raise InputError(f"a quaternion qx qy qz qw must have length 1, got {row[4:].tolist()}")
    pose = np.eye(4)
    pose[:3, 3], pose[:3, :3] = row[1:4], Rotation.from_quat(row[4:]).as_matrix()
    return pose


def _rigid(pose: NDArray[np.float64], number: int) -> NDArray[np.float64]:
    rotation = pose[:3, :3]
    if (
        not np.isfinite(pose).all()
        or np.abs(pose[3] - [0, 0, 0, 1]).max() > _RIGID
        or np.abs(rotation @ rotation.T - np.eye(3)).max() > _RIGID
        or np.linalg.det(rotation) < 0
    ):
        raise InputError(
            f"pose {number} must be a rigid motion, a rotation and a shift with the last row 0 0 0 1, got"
            f" {pose.round(4).tolist()}"
        )
    left, _, right = np.linalg.svd(rotation)
    rigid = np.eye(4)
    rigid[:3, :3], rigid[:3, 3] = left @ right, pose[:3, 3]
    return rigid
