"""Intrinsics from three kinds of files, lens distortion and its inverse, and files that break a rule."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.camera_intrinsics import CameraIntrinsics, read_intrinsics
from lifelore.perception.clouds.point_cloud import PointCloud

PLAIN = {"fx": 525.0, "fy": 520.0, "cx": 319.5, "cy": 239.5, "width": 640, "height": 480}
CAMERA_INFO = """\
image_width: 640
image_height: 480
camera_name: kinect
camera_matrix:
  rows: 3
  cols: 3
  data: [525.0, 0.0, 319.5, 0.0, 520, 239.5, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.1, -0.2, 0.001, 0.002, 0.05]
"""
MESSAGE = """\
header:
  frame_id: camera
height: 480
width: 640
distortion_model: plumb_bob
d: [0.0, 0.0, 0.0, 0.0, 0.0]
k:
- 525.0
- 0.0
- 319.5
- 0.0
- 520.0
- 239.5
- 0.0
- 0.0
- 1.0
binning_x: 0
roi: {x_offset: 0, y_offset: 0, height: 0, width: 0}
---
"""


def written(folder: Path, text: str, name: str = "camera.yaml") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_plain_json_a_camera_info_file_and_a_printed_message_agree(tmp_path: Path) -> None:
    plain = read_intrinsics(written(tmp_path, json.dumps(PLAIN), "camera.json"))
    assert plain == CameraIntrinsics(640, 480, 525.0, 520.0, 319.5, 239.5)
    from_file = read_intrinsics(written(tmp_path, CAMERA_INFO))
    assert from_file == CameraIntrinsics(640, 480, 525.0, 520.0, 319.5, 239.5, (0.1, -0.2, 0.001, 0.002, 0.05))
    named = replace(plain, frame="camera")
    assert read_intrinsics(written(tmp_path, MESSAGE)) == named
    older = MESSAGE.replace("\nd:", "\nD:").replace("\nk:", "\nK:")
    assert read_intrinsics(written(tmp_path, older)) == named
    assert PointCloud.from_depth(np.ones((480, 640)), named).frame == ("camera", None)


def test_rays_of_a_pinhole_by_hand() -> None:
    rays = CameraIntrinsics(3, 2, fx=2.0, fy=4.0, cx=1.0, cy=0.5).rays()
    assert rays[..., 0].tolist() == [[-0.5, 0.0, 0.5]] * 2
    assert rays[..., 1].tolist() == [[-0.125] * 3, [0.125] * 3]


def test_radial_distortion_by_hand() -> None:
    # k1 alone: a ray of slope 0.5 appears at 0.5 · (1 + 0.2 · 0.25) = 0.525.
    camera = CameraIntrinsics(2, 1, 1.0, 1.0, 0.0, 0.0, (0.2,))
    assert camera.distorted(np.array([0.5, 0.0])).tolist() == pytest.approx([0.525, 0.0])
    # p1 and p2 alone, at (0.5, 0): x + p2 · 3 · 0.25, p1 · 0.25.
    camera = CameraIntrinsics(2, 1, 1.0, 1.0, 0.0, 0.0, (0.0, 0.0, 0.1, 0.2))
    assert camera.distorted(np.array([0.5, 0.0])).tolist() == pytest.approx([0.65, 0.025])


@pytest.mark.parametrize(
    "distortion", [(0.1, -0.2, 0.001, 0.002, 0.05), (-0.3, 0.1), (0.2, 0.1, 0.0, 0.001, 0.0, 0.25, 0.05, 0.01)]
)
def test_undistorted_rays_appear_at_their_pixels(distortion: tuple[float, ...]) -> None:
    camera = CameraIntrinsics(64, 48, 52.5, 52.5, 31.5, 23.5, distortion)
    seen = camera.distorted(camera.rays())
    columns, rows = np.meshgrid(np.arange(64), np.arange(48))
    np.testing.assert_allclose(seen[..., 0] * 52.5 + 31.5, columns, atol=1e-3)
    np.testing.assert_allclose(seen[..., 1] * 52.5 + 23.5, rows, atol=1e-3)
    assert np.abs(camera.rays() - CameraIntrinsics(64, 48, 52.5, 52.5, 31.5, 23.5).rays()).max() > 1e-3


def test_a_distortion_without_inverse_is_refused() -> None:
    # The image folds back where 1 + 3 · k1 · r² = 0, at slope 0.41; the corner of the image lies at 0.76.
    with pytest.raises(InputError, match="cannot be undone"):
        CameraIntrinsics(64, 48, 52.5, 52.5, 31.5, 23.5, (-2.0,)).rays()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "holds no keys"),
        ("[1, 2]", "holds no keys"),
        ("a: b: c", "is damaged or not a camera_info"),
        (json.dumps({**PLAIN, "fx": 0}), "focal lengths fx and fy must be positive"),
        (json.dumps({**PLAIN, "fy": float("nan")}), "focal lengths"),
        (json.dumps({**PLAIN, "fx": "wide"}), "fx must be 1 numbers, got wide"),
        (json.dumps({**PLAIN, "width": 0}), "width and height must be 1 to"),
        (json.dumps({**PLAIN, "width": 640.5}), "whole number of pixels"),
        (json.dumps({**PLAIN, "width": float("inf")}), "is damaged or not"),
        (json.dumps({**PLAIN, "cx": float("inf")}), "must be finite"),
        (json.dumps({key: PLAIN[key] for key in ("fx", "fy", "width", "height")}), "has no cx, cy; its keys are"),
        (CAMERA_INFO.replace("image_width", "columns"), "has no image_width"),
        (CAMERA_INFO.replace("data: [525.0, ", "data: ["), "camera_matrix must be 9 numbers"),
        (CAMERA_INFO.replace("525.0, 0.0", "525.0, 0.3"), "camera_matrix must be fx 0 cx"),
        (CAMERA_INFO.replace("plumb_bob", "equidistant"), "'equidistant' with 5 coefficients cannot be undone"),
        (CAMERA_INFO.replace("0.05]", "0.05, 0.1]"), "'plumb_bob' with 6 coefficients"),
        (MESSAGE.replace("binning_x: 0", "binning_x: 2"), "binning or a region of interest"),
        (MESSAGE.replace("x_offset: 0", "x_offset: 8"), "binning or a region of interest"),
    ],
)
def test_a_bad_file_is_one_line_that_names_it(tmp_path: Path, text: str, said: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(InputError, match=said) as caught:
        read_intrinsics(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named() -> None:
    with pytest.raises(InputError, match=r"nowhere\.yaml: no such file"):
        read_intrinsics("nowhere.yaml")
