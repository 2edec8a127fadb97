"""Colours of objects, distinguishable with every common colour blindness."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from lifelore.figures.style import BLUE, GREEN, INK, ORANGE, PAPER, PURPLE, SKY, VERMILION, YELLOW

_SLATE = "#4a525c"
_OBJECTS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, _SLATE, YELLOW)
"""More objects than these take them again, darker and then lighter; their labels tell them apart."""


def object_palette(objects: Iterable[int]) -> dict[int, str]:
    """A colour for each object, by its place among all."""
    tones = (lambda c: c, lambda c: mixed(c, INK, 0.4), lambda c: mixed(c, PAPER, 0.45))
    return {
        number: tones[place // len(_OBJECTS) % len(tones)](_OBJECTS[place % len(_OBJECTS)])
        for place, number in enumerate(sorted(objects))
    }


def rgb(colour: str) -> NDArray[np.float64]:
    """Red, green, blue in [0, 1] of ``#rrggbb``."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255


def mixed(colour: str, other: str, share: float) -> str:
    """`colour` with a `share` of `other` in it."""
    parts = np.round(255 * ((1 - share) * rgb(colour) + share * rgb(other))).astype(int)
    return "#" + "".join(f"{part:02x}" for part in parts)
