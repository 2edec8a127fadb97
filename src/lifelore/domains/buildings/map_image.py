"""The image of a map: pixels of any common format as whole-number brightness levels.

Levels stay integers, so that thresholds act on a table of a few hundred entries and not on millions of
floats.
"""

import struct
import warnings
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from lifelore.core.errors import InputError

MAX_PIXELS = 100_000_000
_SIXTEEN_BIT = ("I", "I;16", "I;16L", "I;16B", "I;16N")
_DAMAGED = (OSError, SyntaxError, ValueError, EOFError, OverflowError, IndexError, struct.error, zlib.error)


def brightness_levels(path: Path, with_alpha: bool) -> tuple[NDArray, int, NDArray[np.bool_] | None]:
    """The brightness of each pixel as a whole number.

    Parameters
    ----------
    path : Path
        A PGM (plain or binary), PNG or other image: grey, palette, RGB, RGBA, 8 or 16 bits.
    with_alpha : bool
        Count an alpha channel as one more colour.

    Returns
    -------
    sums : (rows, columns) int array
        Sum of the channels.
    brightest : int
        The sum of a white pixel; ``sums / brightest`` is the averaged brightness in [0, 1].
    transparent : (rows, columns) bool, or None
        Pixels that are not opaque; None where the image has no alpha channel.

    Raises
    ------
    InputError
        Not an image, truncated, over `MAX_PIXELS`, or of floats.
    """
    image = _open(path)
    if image.mode in _SIXTEEN_BIT:
        return np.clip(np.asarray(image, dtype=np.int32), 0, 65535), 65535, None
    pixels = np.asarray(image)
    if pixels.ndim == 2:
        return pixels, 255, None
    transparent = pixels[..., 3] < 255 if pixels.shape[2] == 4 else None
    channels = pixels.shape[2] if with_alpha else 3
    return pixels[..., :channels].sum(axis=2, dtype=np.uint16), 255 * channels, transparent


def _open(path: Path) -> Image.Image:
    """The image in mode L, RGB, RGBA or a 16-bit grey."""
    try:
        with warnings.catch_warnings():
            # Pillow warns of large images; the limit here is ours and an error.
            warnings.simplefilter("ignore")
            with Image.open(path) as image:
                if image.width * image.height > MAX_PIXELS:
                    raise InputError(_too_large(path, f"{image.width} x {image.height} pixels"))
                image.load()
                return _plain(image, path)
    except InputError:
        raise
    except Image.DecompressionBombError:
        raise InputError(_too_large(path, "more")) from None
    except _DAMAGED as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(f"map: cannot read the image {path}, it is damaged or no image: {reason}") from None


def _too_large(path: Path, what: str) -> str:
    return f"map: the image {path} must have at most {MAX_PIXELS} pixels, got {what}; use a coarser map"


def _plain(image: Image.Image, path: Path) -> Image.Image:
    if image.mode == "F":
        raise InputError(f"map: the image {path} must hold grey or colour values, got floats; save it as PGM")
    if image.mode in _SIXTEEN_BIT:
        return image.copy()
    if "A" in image.getbands() or "a" in image.getbands() or "transparency" in image.info:
        return image.convert("RGBA")
    if image.mode in ("1", "L"):
        return image.convert("L")
    return image.convert("RGB")
