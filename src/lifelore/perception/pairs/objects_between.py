"""What lies between two objects: things above and below a thin layer look near, but the layer carries.

A pair by itself cannot show it. Of the objects that are near both, the one closest to the middle of their contact
is the third thing; how close it comes, and how its gaps compare with theirs, is all that is told.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.contacts.near_pairs import ObjectCloud

THIRD_COLUMNS = ("third_way", "third_gap_a", "third_gap_b")
NOTHING = 0.1
"""Metres in all columns where nothing is near both; more than `ContactSettings.near` lets any gap be."""


class ThirdThings:
    """The near pairs among a scene's objects, to be asked what lies between two of them.

    Parameters
    ----------
    found : iterable of Interface
        With their points (`Interface.pair`). Pairs with the table are left aside: it lies beneath everything.
    """

    def __init__(self, found: Iterable[Interface]) -> None:
        self._gaps: dict[int, dict[int, float]] = {}
        self._things: dict[int, ObjectCloud] = {}
        for one in found:
            if TABLE in (one.a, one.b) or one.pair is None:
                continue
            self._things |= {one.a: one.pair.first, one.b: one.pair.second}
            self._gaps.setdefault(one.a, {})[one.b] = one.gap
            self._gaps.setdefault(one.b, {})[one.a] = one.gap

    def between(self, a: int, b: int, middle: NDArray[np.float64]) -> tuple[float, float, float]:
        """`THIRD_COLUMNS` of (a, b), metres: from `middle` (3,) to the third thing, and its gaps to a and to b.

        Each at most `NOTHING`.
        """
        near_a, near_b = self._gaps.get(a, {}), self._gaps.get(b, {})
        thirds = [(self._away(c, middle), near_a[c], near_b[c]) for c in sorted(near_a.keys() & near_b.keys())]
        way, gap_a, gap_b = min(thirds, default=(NOTHING, NOTHING, NOTHING))
        return min(way, NOTHING), min(gap_a, NOTHING), min(gap_b, NOTHING)

    def _away(self, thing: int, place: NDArray[np.float64]) -> float:
        apart = self._things[thing].points - place
        return float(np.sqrt(np.einsum("ij,ij->i", apart, apart).min()))
