"""Depth images as organised clouds: by hand, round trips through files, and one line for each mistake."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lifelore.core.errors import InputError
from lifelore.perception import CameraIntrinsics, PointCloud, read_cloud
from lifelore.perception.clouds.depth_file import read_depth_image
from lifelore.perception.clouds.depth_image import metres_of_depth

CAMERA = CameraIntrinsics(3, 2, fx=100.0, fy=50.0, cx=1.0, cy=0.5)
DEPTH = np.array([[500, 0, 1000], [800, 900, 1100]], np.uint16)
COLOURS = np.arange(18, dtype=np.uint8).reshape(2, 3, 3)


@pytest.fixture
def depth_png(tmp_path: Path) -> Path:
    Image.fromarray(DEPTH).save(tmp_path / "depth.png")
    return tmp_path / "depth.png"


def test_points_by_hand(depth_png: Path, tmp_path: Path) -> None:
    Image.fromarray(COLOURS).save(tmp_path / "rgb.png")
    cloud = read_depth_image(depth_png, CAMERA, colour=tmp_path / "rgb.png")
    expected = [
        [-0.005, -0.005, 0.5], [np.nan] * 3, [0.01, -0.01, 1.0],
        [-0.008, 0.008, 0.8], [0.0, 0.009, 0.9], [0.011, 0.011, 1.1],
    ]  # fmt: skip
    np.testing.assert_allclose(cloud.points, expected, atol=1e-6)
    assert cloud.grid == (2, 3)
    assert cloud.camera.tolist() == [0, 0, 0]
    assert cloud.colours.tolist() == COLOURS.reshape(-1, 3).tolist()


@pytest.mark.parametrize(
    ("values", "scale"),
    [(DEPTH, None), (DEPTH / 1000, None), ((DEPTH / 1000).astype(np.float32), None), (DEPTH * 10, 0.0001),
     (np.where(DEPTH == 0, np.nan, DEPTH), 0.001), (np.where(DEPTH == 0, -1, DEPTH.astype(np.int32)), None)],
)  # fmt: skip
def test_numbers_of_any_kind_are_the_same_metres(tmp_path: Path, values: np.ndarray, scale: float | None) -> None:
    np.save(tmp_path / "depth.npy", values)
    cloud = read_depth_image(tmp_path / "depth.npy", CAMERA, depth_scale=scale)
    expected = PointCloud.from_depth(DEPTH, CAMERA)
    np.testing.assert_allclose(cloud.points, expected.points, atol=1e-6)
    assert cloud.measured.tolist() == [True, False, True, True, True, True]


def test_a_jpeg_gives_colours(depth_png: Path, tmp_path: Path) -> None:
    Image.fromarray(np.full((2, 3, 3), (200, 40, 90), np.uint8)).save(tmp_path / "rgb.jpg", quality=95)
    cloud = read_depth_image(depth_png, CAMERA, colour=tmp_path / "rgb.jpg")
    assert np.abs(cloud.colours.astype(int) - (200, 40, 90)).max() <= 8


def test_distorted_pixels_are_seen_along_undistorted_rays() -> None:
    lens = CameraIntrinsics(3, 2, 100.0, 50.0, 1.0, 0.5, (0.3,))
    cloud = PointCloud.from_depth(np.full((2, 3), 1.0), lens)
    slopes = lens.distorted(cloud.points[:, :2]).reshape(2, 3, 2)
    np.testing.assert_allclose(slopes, CAMERA.rays(), atol=1e-6)


def test_an_image_of_another_kind_is_refused(tmp_path: Path) -> None:
    def image(array: np.ndarray, name: str) -> Path:
        Image.fromarray(array).save(tmp_path / name)
        return tmp_path / name

    for path, said in [
        (image((DEPTH // 10).astype(np.uint8), "eight.png"), "mode L, not of 16-bit depth"),
        (image(COLOURS, "colours.png"), "mode RGB, not of 16-bit depth"),
        (image(COLOURS, "colours.jpg"), "is no PNG"),
        (image(DEPTH[:, :2].copy(), "narrow.png"), "2 × 2 pixels, but the intrinsics are of 3 × 2"),
        (image(np.zeros_like(DEPTH), "dark.png"), "no measured depth among 6 pixels"),
        (tmp_path / "missing.png", "no such file"),
    ]:
        with pytest.raises(InputError, match=said) as caught:
            read_depth_image(path, CAMERA)
        assert str(caught.value).startswith(f"{path}: ")
        assert "\n" not in str(caught.value)


def test_a_damaged_png_is_refused(depth_png: Path) -> None:
    content = depth_png.read_bytes()
    depth_png.write_bytes(content[:45])
    with pytest.raises(InputError, match="is damaged or not a depth image"):
        read_depth_image(depth_png, CAMERA)
    depth_png.write_text("hello")
    with pytest.raises(InputError, match="is no depth image"):
        read_depth_image(depth_png, CAMERA)


def test_a_colour_image_of_another_size_or_kind_is_refused(depth_png: Path, tmp_path: Path) -> None:
    Image.fromarray(COLOURS[:, :2].copy()).save(tmp_path / "rgb.png")
    with pytest.raises(InputError, match=r"depth\.png: the colour image has 2 × 2 pixels, the depth image 3 × 2"):
        read_depth_image(depth_png, CAMERA, colour=tmp_path / "rgb.png")
    (tmp_path / "rgb.png").write_text("hello")
    with pytest.raises(InputError, match=r"rgb\.png: is damaged or not a PNG or JPEG image"):
        read_depth_image(depth_png, CAMERA, colour=tmp_path / "rgb.png")


@pytest.mark.parametrize(
    ("values", "scale", "said"),
    [
        (DEPTH[0], None, "shape"),
        (DEPTH.astype(np.uint8), None, "16-bit"),
        (DEPTH > 0, None, "16-bit"),
        (DEPTH, 0.0, "depth_scale must be a positive"),
        (DEPTH, float("nan"), "depth_scale must be a positive"),
    ],
)
def test_depth_of_another_shape_or_scale_is_refused(values: np.ndarray, scale: float | None, said: str) -> None:
    with pytest.raises(InputError, match=said):
        metres_of_depth(values, scale)


def test_millimetres_as_floats_are_refused_with_the_scale(tmp_path: Path) -> None:
    np.save(tmp_path / "depth.npy", np.linspace(500.0, 1100.0, 6).reshape(2, 3))
    with pytest.raises(InputError, match=r"median depth of 800\.0 m.*depth_scale=0\.001"):
        read_depth_image(tmp_path / "depth.npy", CAMERA)


def test_an_image_without_intrinsics_says_what_is_missing(depth_png: Path) -> None:
    with pytest.raises(InputError, match=r"is an image, not a cloud; a depth image needs.*--intrinsics"):
        read_cloud(depth_png)
