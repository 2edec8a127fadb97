"""`CameraIntrinsics`: focal lengths, principal point, image size and lens distortion of a camera."""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.file_content import file_content, one_line_errors

KINDS = "a camera_info YAML or a JSON file with fx, fy, cx, cy, width, height"
MAX_SIDE = 20_000
"""Pixels; larger images are refused."""
_MODELS = {"": 0, "plumb_bob": 5, "rational_polynomial": 8}
"""Distortion models that are undone, and their largest numbers of coefficients."""
_LIMIT = 2**20
_ROUNDS = 50
_TOLERANCE = 1e-7
"""Of a ray's slope; 525 pixels of focal length make it 5e-5 pixels."""
_MISFIT = 0.05
"""Pixels between a pixel and its undistorted ray, distorted again; above it, the lens model has no inverse."""


@dataclass(frozen=True)
class CameraIntrinsics:
    """A pinhole camera with lens distortion; x right, y down, z forward.

    Parameters
    ----------
    width, height : int
        Pixels of the image, 1 to `MAX_SIDE`.
    fx, fy : float
        Focal lengths, pixels, > 0.
    cx, cy : float
        Principal point, pixels; the centre of the first pixel is (0, 0).
    distortion : tuple of float
        Coefficients k1, k2, p1, p2, k3, k4, k5, k6 of OpenCV's model, at most 8 (*plumb_bob*: the first five;
        *rational_polynomial*: all). Empty or zeros for a rectified image.
    frame : str, optional
        Name of the camera's frame (frame_id), where the file names it.

    Raises
    ------
    InputError
        A value breaks its rule.

    Examples
    --------
    >>> CameraIntrinsics(640, 480, 525.0, 525.0, 319.5, 239.5).grid
    (480, 640)
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()
    frame: str | None = None

    def __post_init__(self) -> None:
        if not (1 <= self.width <= MAX_SIDE and 1 <= self.height <= MAX_SIDE):
            raise InputError(
                f"width and height must be 1 to {MAX_SIDE} pixels, got {self.width} and {self.height}"
            )
        if not (np.isfinite([self.fx, self.fy]).all() and self.fx > 0 and self.fy > 0):
            raise InputError(f"focal lengths fx and fy must be positive pixels, got {self.fx} and {self.fy}")
        if not np.isfinite([self.cx, self.cy, *self.distortion]).all() or len(self.distortion) > 8:
            raise InputError(
                f"cx, cy and at most 8 distortion coefficients must be finite, got {self.cx}, {self.cy} and"
                f" {self.distortion}"
            )

    @property
    def grid(self) -> tuple[int, int]:
        """(height, width) of the image."""
        return self.height, self.width

    def rays(self) -> NDArray[np.float64]:
        """(height, width, 2) slopes x/z and y/z of the line of sight of each pixel, without distortion.

        Raises
        ------
        InputError
            The distortion cannot be undone at some pixels.
        """
        x, y = np.broadcast_arrays(
            (np.arange(self.width) - self.cx) / self.fx, (np.arange(self.height)[:, None] - self.cy) / self.fy
        )
        seen = np.stack([x, y], axis=-1)
        return self._undistorted(seen) if any(self.distortion) else seen

    def distorted(self, rays: NDArray[np.float64]) -> NDArray[np.float64]:
        """(…, 2) slopes at which the lens shows slopes `rays` (…, 2)."""
        k1, k2, p1, p2, k3, k4, k5, k6 = (*self.distortion, *(0.0,) * (8 - len(self.distortion)))
        x, y = rays[..., 0], rays[..., 1]
        r2 = x * x + y * y
        radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
        return np.stack(
            [
                x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
            ],
            axis=-1,
        )

    def _undistorted(self, seen: NDArray[np.float64]) -> NDArray[np.float64]:
        """The inverse of `distorted` by fixed-point steps, checked."""
        rays = seen.copy()
        with np.errstate(all="ignore"):
            for _ in range(_ROUNDS):
                step = seen - self.distorted(rays)
                rays += step
                if np.abs(step).max() <= _TOLERANCE:
                    break
            misfit = np.abs(self.distorted(rays) - seen).max() * max(self.fx, self.fy)
        if not misfit <= _MISFIT:
            raise InputError(
                f"the lens distortion {self.distortion} cannot be undone over the whole image: rectify the image,"
                " then give intrinsics without distortion"
            )
        return rays

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> "CameraIntrinsics":
        """Intrinsics of one of three mappings.

        Parameters
        ----------
        values : mapping
            ``fx, fy, cx, cy, width, height`` and optionally ``distortion``; or a camera_info file (``image_width,
            image_height, camera_matrix, distortion_model, distortion_coefficients``); or a printed
            ``sensor_msgs/CameraInfo`` (``width, height, k, d, distortion_model, header``, in any case).

        Raises
        ------
        InputError
            A key is missing, a value breaks its rule, or the distortion model is not known.
        """
        held = {str(key).lower(): value for key, value in values.items()}
        if "camera_matrix" in held or "k" in held:
            return cls._from_camera_info(held)
        names = ("fx", "fy", "cx", "cy", "width", "height")
        _check_keys(held, names)
        fx, fy, cx, cy = (_numbers(held[name], name, 1)[0] for name in names[:4])
        distortion = tuple(_numbers(held.get("distortion", []), "distortion"))
        return cls(_whole(held["width"], "width"), _whole(held["height"], "height"), fx, fy, cx, cy, distortion)

    @classmethod
    def _from_camera_info(cls, held: Mapping[str, Any]) -> "CameraIntrinsics":
        from_file = "camera_matrix" in held
        width, height, matrix, coefficients = (
            ("image_width", "image_height", "camera_matrix", "distortion_coefficients")
            if from_file
            else ("width", "height", "k", "d")
        )
        _check_keys(held, (width, height))
        k = _numbers(_data(held[matrix]), matrix, 9)
        if k[1] or k[3] or k[6:] != [0.0, 0.0, 1.0]:
            raise InputError(f"{matrix} must be fx 0 cx 0 fy cy 0 0 1, row by row, got {k}")
        if _cropped(held):
            raise InputError(
                "camera_info with binning or a region of interest is not read: give fx, fy, cx, cy as JSON"
            )
        distortion = _numbers(_data(held.get(coefficients) or []), coefficients)
        model = str(held.get("distortion_model") or "")
        if any(distortion) and len(distortion) > _MODELS.get(model or "rational_polynomial", 0):
            raise InputError(
                f"distortion model {model[:40]!r} with {len(distortion)} coefficients cannot be undone: rectify"
                f" the image and give zeros, or use {' or '.join(name for name in _MODELS if name)}"
            )
        size = _whole(held[width], width), _whole(held[height], height)
        header = held.get("header")
        frame = str(header.get("frame_id") or "") if isinstance(header, Mapping) else ""
        return cls(*size, k[0], k[4], k[2], k[5], tuple(distortion) if any(distortion) else (), frame or None)


def read_intrinsics(path: str | os.PathLike[str]) -> CameraIntrinsics:
    """Read the intrinsics of a camera; see `CameraIntrinsics.from_mapping` for the keys of the YAML or JSON file.

    Raises
    ------
    InputError
        The file is missing or damaged, a key is missing, or a value breaks its rule; the message names it.
    """
    return one_line_errors(str(path), KINDS, lambda: CameraIntrinsics.from_mapping(_mapping(Path(path))))


def _mapping(path: Path) -> Mapping[str, Any]:
    text = file_content(path, KINDS, _LIMIT).decode("utf-8", "replace")
    try:
        values = json.loads(text)
    except ValueError:
        import yaml

        # A printed message ends with "---", which begins an empty document.
        values = next(iter(yaml.safe_load_all(text)), None)
    if not isinstance(values, Mapping):
        raise InputError(f"holds no keys with values; give {KINDS}")
    return values


def _check_keys(held: Mapping[str, Any], names: Sequence[str]) -> None:
    missing = [name for name in names if name not in held]
    if missing:
        raise InputError(
            f"has no {', '.join(missing)}; its keys are {', '.join(held)[:200] or 'none'}; give {KINDS}"
        )


def _data(value: Any) -> Any:
    return value.get("data", []) if isinstance(value, Mapping) else value


def _cropped(held: Mapping[str, Any]) -> bool:
    region = held.get("roi")
    offsets = [region.get("x_offset"), region.get("y_offset")] if isinstance(region, Mapping) else []
    return any(offsets) or any(held.get(f"binning_{axis}") not in (None, 0, 1) for axis in "xy")


def _numbers(value: Any, name: str, n: int | None = None) -> list[float]:
    values = value if isinstance(value, list | tuple) else [value]
    if any(isinstance(v, bool) or not isinstance(v, int | float) for v in values) or n not in (None, len(values)):
        raise InputError(f"{name} must be {'' if n is None else f'{n} '}numbers, got {str(value)[:100]}")
    return [float(v) for v in values]


def _whole(value: Any, name: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int | float) or value != int(value):
        raise InputError(f"{name} must be a whole number of pixels, got {str(value)[:40]}")
    return int(value)
