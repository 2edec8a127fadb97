"""Poses in four formats, and files that break a rule."""

import json
from pathlib import Path

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.pose_file import read_poses

TURN = np.array([[0.0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
"""A quarter turn about z, then a shift by (1, 2, 3)."""
POSES = np.stack([np.eye(4), TURN])


def test_four_formats_agree(tmp_path: Path) -> None:
    half = np.sqrt(0.5)
    files = {
        "list.json": json.dumps(POSES.tolist()),
        "object.json": json.dumps({"poses": POSES.tolist()}),
        "tum.txt": f"# time x y z qx qy qz qw\n0.0 0 0 0 0 0 0 1\n0.1 1 2 3 0 0 {half} {half}\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    np.savez(tmp_path / "poses.npz", poses=POSES)
    np.save(tmp_path / "poses.npy", POSES)
    for name in [*files, "poses.npz", "poses.npy"]:
        np.testing.assert_allclose(read_poses(tmp_path / name, 2), POSES, atol=1e-12)


def test_rotations_are_made_exact(tmp_path: Path) -> None:
    rough = POSES + np.random.default_rng(0).normal(0, 1e-4, POSES.shape) * [[1], [1], [1], [0]]
    np.save(tmp_path / "poses.npy", rough)
    found = read_poses(tmp_path / "poses.npy", 2)
    for pose in found[:, :3, :3]:
        np.testing.assert_allclose(pose @ pose.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(found, rough, atol=1e-3)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (json.dumps(POSES[:1].tolist()), "must hold 2 poses"),
        (json.dumps({"views": []}), "must hold 2 poses"),
        (json.dumps((POSES * 2).tolist()), "pose 0 must be a rigid motion"),
        (json.dumps((POSES * [[1], [-1], [1], [1]]).tolist()), "pose 0 must be a rigid motion"),
        (json.dumps(POSES.tolist()).replace("3.0", "NaN"), "pose 1 must be a rigid motion"),
        ("[[1, 2], [3]]", "is damaged or not"),
        ("0 0 0 0 0 0 1\n" * 2, "lines of 7 numbers, but a pose has 8"),
        ("0 0 0 0 0 0 0 2\n" * 2, "must have length 1"),
        ("hello", "is damaged or not"),
        ("# nothing", "is damaged or not|lines of|must hold 2"),
    ],
)
def test_a_bad_file_is_one_line(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "poses.txt"
    path.write_text(text)
    with pytest.raises(InputError, match=said) as caught:
        read_poses(path, 2)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)
