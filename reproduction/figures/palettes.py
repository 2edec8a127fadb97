"""Colours of relations and methods, distinguishable with every common colour blindness."""

from collections.abc import Iterable
from itertools import cycle

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, YELLOW

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
