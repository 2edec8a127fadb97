"""Features of a third object between two others, such as a thin layer between the objects above and below it.

Of the objects near both, the third object is the one closest to the middle of their contact. The features are its
distance from there and its gaps to the two.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.contacts.near_pairs import ObjectCloud

BETWEEN_COLUMNS = ("third_way", "third_gap_a", "third_gap_b")
NO_OBJECT = 0.1
"""Metres in all columns where no object is near both; above the largest gap of a near pair."""


class ObjectsBetween:
    """Finds the object between two others, from the near pairs of a scene.

    Parameters
    ----------
    found : iterable of Interface
        With their points (`Interface.pair`). Pairs with the table are ignored.
    """

    def __init__(self, found: Iterable[Interface]) -> None:
        self._gaps: dict[int, dict[int, float]] = {}
        self._clouds: dict[int, ObjectCloud] = {}
        for interface in found:
            if TABLE in (interface.a, interface.b) or interface.pair is None:
                continue
            self._clouds |= {interface.a: interface.pair.first, interface.b: interface.pair.second}
            self._gaps.setdefault(interface.a, {})[interface.b] = interface.gap
            self._gaps.setdefault(interface.b, {})[interface.a] = interface.gap

    def between(self, a: int, b: int, middle: NDArray[np.float64]) -> tuple[float, float, float]:
        """`BETWEEN_COLUMNS` of (a, b), metres: from `middle` (3,) to the third object, and its gaps to a and to b.

        Each at most `NO_OBJECT`.
        """
        near_a, near_b = self._gaps.get(a, {}), self._gaps.get(b, {})
        thirds = [(self._away(c, middle), near_a[c], near_b[c]) for c in sorted(near_a.keys() & near_b.keys())]
        way, gap_a, gap_b = min(thirds, default=(NO_OBJECT, NO_OBJECT, NO_OBJECT))
        return min(way, NO_OBJECT), min(gap_a, NO_OBJECT), min(gap_b, NO_OBJECT)

    def _away(self, number: int, place: NDArray[np.float64]) -> float:
        apart = self._clouds[number].points - place
        return float(np.sqrt(np.einsum("ij,ij->i", apart, apart).min()))
