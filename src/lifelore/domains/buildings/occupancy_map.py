"""Occupancy maps: a ROS ``map_server`` YAML and its image, read to free, occupied and unknown pixels.

With p = (255 - v) / 255 of the averaged colour v (p = v / 255 under `negate`):

- ``trinary`` (default): occupied where p > occupied_thresh, free where p < free_thresh, else unknown; an
  alpha channel is averaged in with the colours, as ``map_server`` does.
- ``scale``: the same thresholds without alpha in the average; a pixel that is not opaque is unknown.
- ``raw``: v itself (255 - v under `negate`) is the occupancy in percent, above 100 unknown; the percent is
  held against the same thresholds.

``map_server`` publishes grades between the thresholds in the last two; here they are unknown: the map does
not confirm that a robot fits there.
"""

import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import ArrayLike, NDArray

from lifelore.core.atomic_write import refused_writes
from lifelore.core.errors import InputError
from lifelore.domains.buildings.map_image import brightness_levels
from lifelore.domains.grids.grid_world import Frame

FREE, OCCUPIED, UNKNOWN = 0, 1, 2
"""States of a pixel."""
MODES = ("trinary", "scale", "raw")
_REQUIRED = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")
_MAX_YAML_BYTES = 1_000_000
_GREY_OF_STATE = np.array([254, 0, 205], np.uint8)  # what map_saver writes; 205 lies between the thresholds


@dataclass(frozen=True, eq=False)
class OccupancyMap:
    """Map of a floor: the occupancy of each pixel.

    Parameters
    ----------
    state : (rows, columns) uint8
        `FREE`, `OCCUPIED` or `UNKNOWN`; row 0 is the top of the picture, the largest y.
    resolution : float
        Side of a pixel in metres.
    origin : (x, y, yaw)
        World pose of the lower left corner of the lower left pixel, metres and radians.
    source : str
        Where it came from, for people.

    Examples
    --------
    >>> OccupancyMap(np.zeros((20, 30), np.uint8), resolution=0.05).state.shape
    (20, 30)
    """

    state: NDArray[np.uint8]
    resolution: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    source: str = ""

    def __post_init__(self) -> None:
        if self.state.ndim != 2 or self.state.size == 0:
            raise InputError(f"state must be a (rows, columns) array with pixels, got shape {self.state.shape}")
        if not (math.isfinite(self.resolution) and self.resolution > 0):
            raise InputError(f"resolution must be a positive number of metres a pixel, got {self.resolution}")
        if len(self.origin) != 3 or not all(math.isfinite(value) for value in self.origin):
            raise InputError(f"origin must be three numbers [x, y, yaw], got {list(self.origin)}")

    @property
    def frame(self) -> Frame:
        """The frame of the pixels."""
        return Frame(self.resolution, self.origin)

    def pixels(self, points: ArrayLike) -> NDArray[np.float64]:
        """Row and column (n, 2) of points (n, 2) in metres of the map's frame; pixel centres are whole.

        They are rounded to 1e-9, so that a point on a border lies in the same pixel in a map and in a part of it.
        """
        right, up = self.frame.cells(points)
        return np.column_stack([len(self.state) - 0.5 - up, right - 0.5]).round(9)

    def metres(self, pixels: ArrayLike) -> NDArray[np.float64]:
        """Points (n, 2) in metres of the map's frame, of rows and columns (n, 2); the inverse of `pixels`."""
        row, column = np.asarray(pixels, float).reshape(-1, 2).T
        return self.frame.metres(column + 0.5, len(self.state) - 0.5 - row)

    def values_at(self, points: ArrayLike, values: NDArray[np.uint8], outside: int) -> NDArray[np.uint8]:
        """The `values` (rows, columns) of the pixels in which points (n, 2) in metres lie; `outside` elsewhere."""
        row, column = self.pixels(points).T
        row, column = np.ceil(row - 0.5).astype(np.int64), np.floor(column + 0.5).astype(np.int64)
        inside = (row >= 0) & (row < values.shape[0]) & (column >= 0) & (column < values.shape[1])
        return np.where(inside, values[np.where(inside, row, 0), np.where(inside, column, 0)], np.uint8(outside))

    @property
    def grey(self) -> NDArray[np.uint8]:
        """(rows, columns) uint8 picture as ROS's ``map_saver`` draws it: free 254, occupied 0, unknown 205."""
        return _GREY_OF_STATE[self.state]


def read_occupancy_map(path: str | Path) -> OccupancyMap:
    """Read a ``map_server`` map.

    Parameters
    ----------
    path : str or Path
        The YAML file; its ``image`` is looked for relative to it.

    Raises
    ------
    InputError
        The YAML or the image is missing, damaged, too large (over 10⁸ pixels) or breaks a rule of the
        format; the message names the file, the key and the rule.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> drawn = OccupancyMap(np.zeros((20, 30), np.uint8), resolution=0.05)
    >>> with TemporaryDirectory() as folder:
    ...     path = write_occupancy_map(f"{folder}/room.yaml", drawn)
    ...     read_occupancy_map(f"{folder}/room.yaml").resolution
    0.05
    """
    path = Path(path)
    mapping = _mapping_from(path)
    free, occupied = (_number(path, mapping, key) for key in ("free_thresh", "occupied_thresh"))
    if not 0 <= free < occupied <= 1:
        raise InputError(
            f"map: {path}: thresholds must satisfy 0 <= free_thresh < occupied_thresh <= 1, "
            f"got free_thresh {free} and occupied_thresh {occupied}"
        )
    resolution = _number(path, mapping, "resolution")
    if resolution <= 0:
        raise InputError(f"map: {path}: resolution must be positive, in metres a pixel, got {resolution}")
    mode = mapping.get("mode", "trinary")
    if mode not in MODES:
        raise InputError(f"map: {path}: mode must be one of {', '.join(MODES)}, got {mode!r}")
    origin, negate = _origin(path, mapping["origin"]), _flag(path, mapping["negate"])
    image = _image(path, mapping["image"])
    sums, brightest, transparent = brightness_levels(image, with_alpha=mode == "trinary")
    occupancy = _occupancy_of_level(brightest, mode, negate)
    state = np.select([occupancy > occupied, occupancy < free], [OCCUPIED, FREE], UNKNOWN).astype(np.uint8)[sums]
    if mode == "scale" and transparent is not None:
        state[transparent] = UNKNOWN
    return OccupancyMap(state, resolution, origin, str(path))


def _occupancy_of_level(brightest: int, mode: str, negate: bool) -> NDArray[np.float64]:
    """The occupancy in [0, 1] of each brightness 0 … `brightest`; NaN is on neither side of a threshold."""
    brightness = np.arange(brightest + 1) * 255.0 / brightest
    if mode == "raw":
        percent = np.rint(255.0 - brightness if negate else brightness)
        return np.where(percent <= 100, percent / 100, np.nan)
    return (brightness if negate else 255.0 - brightness) / 255.0


def _mapping_from(path: Path) -> dict:
    if not os.path.isfile(path):
        raise InputError(f"map: no such file: {path}; give the YAML file of a ROS map")
    if path.stat().st_size > _MAX_YAML_BYTES:
        raise InputError(f"map: {path} is too large for a map YAML; give the YAML file, not the image")
    try:
        mapping = yaml.safe_load(path.read_bytes())
    except (yaml.YAMLError, UnicodeDecodeError, ValueError, RecursionError) as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(f"map: {path} is not YAML ({reason}); give the YAML file of a ROS map") from None
    except OSError as error:
        raise InputError(f"map: cannot read {path}: {error.strerror}") from None
    if not isinstance(mapping, dict):
        raise InputError(f"map: {path} is not a map YAML: it must hold the keys {', '.join(_REQUIRED)}")
    if missing := [key for key in _REQUIRED if mapping.get(key) is None]:
        raise InputError(f"map: {path} lacks {', '.join(missing)}; a ROS map has {', '.join(_REQUIRED)}")
    return mapping


def _number(path: Path, mapping: dict, key: str) -> float:
    value = mapping[key]
    try:
        # PyYAML leaves 5e-2 a string where the C++ readers see a number.
        number = math.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"map: {path}: {key} must be a finite number, got {str(value)[:60]!r}")
    return number


def _origin(path: Path, value: object) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3:
        raise InputError(f"map: {path}: origin must be three numbers [x, y, yaw], got {str(value)[:60]!r}")
    x, y, yaw = (_number(path, {"origin": part}, "origin") for part in value)
    return x, y, yaw


def _flag(path: Path, value: object) -> bool:
    if value not in (0, 1):
        raise InputError(f"map: {path}: negate must be 0 or 1, got {str(value)[:60]!r}")
    return bool(value)


def _image(path: Path, value: object) -> Path:
    if not isinstance(value, str) or not value.strip() or "\0" in value:
        raise InputError(f"map: {path}: image must name an image file, got {str(value)[:60]!r}")
    image = path.parent / Path(value)
    if not os.path.isfile(image):
        raise InputError(f"map: {path}: image {value!r} not found: no file {image}")
    return image


def write_occupancy_map(
    path: str | Path,
    grey: NDArray[np.uint8] | OccupancyMap,
    resolution: float | None = None,
    origin: tuple[float, float, float] | None = None,
    *,
    mode: str = "trinary",
) -> Path:
    """Write a ``map_server`` map: a binary PGM beside its YAML; returns the image's path.

    Parameters
    ----------
    path : str or Path
        The YAML file to write; the image takes its name with the ending ``.pgm``.
    grey : (rows, columns) uint8, or OccupancyMap
        The picture, row 0 at the top; an `OccupancyMap` brings its own resolution and origin.
    resolution : float, optional
        Metres a pixel; needed with an array.
    origin : (x, y, yaw), optional
        Pose of the lower left corner; default (0, 0, 0), or the `OccupancyMap`'s.
    mode : {"trinary", "scale", "raw"}
        How readers are to take the greys; ``raw`` for values that are percentages.

    Raises
    ------
    InputError
        `grey` is not such an array, `mode` is unknown, `resolution` or `origin` breaks its rule.
    StoreError
        The files cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> drawn = OccupancyMap(np.zeros((20, 30), np.uint8), resolution=0.05)
    >>> with TemporaryDirectory() as folder:
    ...     write_occupancy_map(f"{folder}/room.yaml", drawn).name
    'room.pgm'
    """
    if isinstance(grey, OccupancyMap):
        resolution = grey.resolution if resolution is None else resolution
        origin = grey.origin if origin is None else origin
        grey = grey.grey
    if grey.dtype != np.uint8:
        raise InputError(f"grey must be a uint8 array, got {grey.dtype}")
    if mode not in MODES:
        raise InputError(f"mode must be one of {', '.join(MODES)}, got {mode!r}")
    checked = OccupancyMap(grey, math.nan if resolution is None else resolution, origin or (0.0, 0.0, 0.0))
    path = Path(path)
    image = path.with_suffix(".pgm")
    if image == path:
        raise InputError(f"path must name the YAML file, got {path}; the image is written beside it")
    settings = {
        "image": image.name,
        "mode": mode,
        "resolution": float(checked.resolution),
        "origin": [float(value) for value in checked.origin],
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }
    header = f"P5\n{grey.shape[1]} {grey.shape[0]}\n255\n".encode()
    with refused_writes(path, "the map"):
        image.write_bytes(header + np.ascontiguousarray(grey).tobytes())
        path.write_text(yaml.safe_dump(settings, sort_keys=False), encoding="utf-8")
    return image
