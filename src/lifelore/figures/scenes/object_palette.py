"""Colours of objects, relations and methods, distinguishable with every common colour blindness."""

from collections.abc import Iterable
from itertools import cycle

import numpy as np
from numpy.typing import NDArray

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PAPER, PURPLE, SKY, VERMILION, YELLOW

_SLATE = "#4a525c"
_OBJECTS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, _SLATE, YELLOW)
"""More objects than these take them again, darker and then lighter; their labels tell them apart."""

_RELATIONS = {"on": BLUE, "adjacent": ORANGE, "both": GREEN, "none": GREY}
RELATION_MARKERS = {"on": "o", "adjacent": "s", "both": "^", "none": "x"}
_METHODS = {
    "lifelore": BLUE,
    "thesis": VERMILION,
    "closest-point k-NN": GREEN,
    "centroid k-NN": PURPLE,
    "bounding-box rule": ORANGE,
    "orientation histogram": SKY,
    "angle-distance histogram": YELLOW,
    "majority": GREY,
}
_OTHERS = (VERMILION, PURPLE, SKY, YELLOW, INK)


def object_palette(objects: Iterable[int]) -> dict[int, str]:
    """A colour for each object, by its place among all."""
    tones = (lambda c: c, lambda c: mixed(c, INK, 0.4), lambda c: mixed(c, PAPER, 0.45))
    return {
        number: tones[place // len(_OBJECTS) % len(tones)](_OBJECTS[place % len(_OBJECTS)])
        for place, number in enumerate(sorted(objects))
    }


def relation_palette(relations: Iterable[str]) -> dict[str, str]:
    """A colour for each relation: fixed for the thesis's, in alphabetical order for a user's own."""
    own = sorted(set(relations) - set(_RELATIONS))
    return _RELATIONS | {name: _OTHERS[place % len(_OTHERS)] for place, name in enumerate(own)}


def method_palette(methods: Iterable[str]) -> dict[str, str]:
    """A colour for each way of telling relations: fixed for those we know, in the order given for others."""
    methods = list(methods)
    taken = {_METHODS[name] for name in methods if name in _METHODS}
    free = cycle([colour for colour in _OTHERS if colour not in taken] or _OTHERS)
    return {name: _METHODS.get(name) or next(free) for name in methods}


def rgb(colour: str) -> NDArray[np.float64]:
    """Red, green, blue in [0, 1] of ``#rrggbb``."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255


def mixed(colour: str, other: str, share: float) -> str:
    """`colour` with a `share` of `other` in it."""
    parts = np.round(255 * ((1 - share) * rgb(colour) + share * rgb(other))).astype(int)
    return "#" + "".join(f"{part:02x}" for part in parts)
