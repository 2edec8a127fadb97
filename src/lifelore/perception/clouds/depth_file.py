"""RGB-D images as organised clouds: a depth image, the camera's intrinsics, and an aligned colour image."""

import os
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.camera_intrinsics import CameraIntrinsics, read_intrinsics
from lifelore.perception.clouds.cloud_columns import MAX_POINTS
from lifelore.perception.clouds.cloud_file import IMAGES
from lifelore.perception.clouds.cloud_scale import MAX_SPAN, in_metres
from lifelore.perception.clouds.file_content import file_content, one_line_errors
from lifelore.perception.clouds.npz_file import array_of_npy
from lifelore.perception.clouds.point_cloud import PointCloud

DEPTH_KINDS = "a 16-bit PNG or an npy file with depth"
COLOUR_KINDS = "a PNG or JPEG image"


def read_depth_image(
    depth: str | os.PathLike[str],
    intrinsics: str | os.PathLike[str] | CameraIntrinsics,
    *,
    colour: str | os.PathLike[str] | None = None,
    depth_scale: float | None = None,
) -> PointCloud:
    """Read a depth image as an organised cloud.

    Parameters
    ----------
    depth : path
        A PNG of 16 bits and a single channel, or an npy file of shape (height, width); depth is along the optical
        axis. Zero, negative and NaN mean that nothing was measured.
    intrinsics : path or CameraIntrinsics
        See `read_intrinsics`. Lens distortion is undone for each pixel's line of sight.
    colour : path, optional
        A PNG or JPEG image of the same size, aligned pixel by pixel with the depth.
    depth_scale : float, optional
        Metres for each unit of depth. Default: 0.001 for whole numbers, 1 for floats.

    Returns
    -------
    PointCloud
        As `PointCloud.from_depth`; points more than 50 m from the median point are not measured.

    Raises
    ------
    InputError
        A file is missing or damaged, the image has 8 bits or colours, sizes differ, no depth was measured, or the
        depth suggests another scale.
    """
    camera = intrinsics if isinstance(intrinsics, CameraIntrinsics) else read_intrinsics(intrinsics)
    colours = (
        None if colour is None else one_line_errors(str(colour), COLOUR_KINDS, lambda: _colours(Path(colour)))
    )

    def cloud() -> PointCloud:
        found = PointCloud.from_depth(_depth(Path(depth)), camera, colours, depth_scale=depth_scale)
        try:
            return in_metres(found)
        except InputError:
            median = float(np.nanmedian(found.points[:, 2]))
            raise InputError(
                f"spans more than {MAX_SPAN:.0f} m at a median depth of {median:,.1f} m: crop the image, or give"
                " another scale (--set depth_scale=0.001 for millimetres)"
            ) from None

    return one_line_errors(str(depth), "a depth image", cloud)


def opened_image(content: bytes):
    """The decoded Pillow image of the bytes of an image file.

    Raises
    ------
    InputError
        It has more than `MAX_POINTS` pixels.
    """
    from PIL import Image

    image = Image.open(BytesIO(content))
    if image.width * image.height > MAX_POINTS:
        raise InputError(f"has {image.width} × {image.height} pixels where at most {MAX_POINTS} are read; crop it")
    image.load()
    return image


def _depth(path: Path) -> NDArray:
    content = file_content(path, DEPTH_KINDS)
    if content.startswith(b"\x93NUMPY"):
        return array_of_npy(content, "depth")
    if not content.startswith(b"\x89PNG"):
        raise InputError(f"is {'no PNG' if content.startswith(IMAGES) else 'no depth image'}; give {DEPTH_KINDS}")
    image = opened_image(content)
    if not image.mode.startswith("I"):
        raise InputError(
            f"is an image of mode {image.mode}, not of 16-bit depth: 8 bits hold no metric depth; give"
            f" {DEPTH_KINDS}"
        )
    return np.asarray(image).astype(np.uint16)


def _colours(path: Path) -> NDArray[np.uint8]:
    return np.asarray(opened_image(file_content(path, COLOUR_KINDS)).convert("RGB"))
