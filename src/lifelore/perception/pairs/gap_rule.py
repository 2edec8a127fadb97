"""Gap rule: neighbours are *adjacent* up to a given visible gap, and *none* beyond it.

The limit is a parameter, because few examples cannot teach it: gaps of hand-labelled *adjacent* and *none* pairs
overlap from 20 to 30 mm. It is a limit of the distance between surfaces. The visible gap is an upper bound of it:
a hidden edge makes the gap wider, never narrower, so the rule allows `HIDDEN_EDGE` more, and the shares change
steeply below the limit and slowly above it. In simulation, surfaces are within 22.5 mm of each other in 0.8 of the
pairs with a visible gap of 21 to 24 mm, and in 0.4 and 0.3 of those with 24 to 27 and 27 to 30 mm. In training
both are one class, `BESIDE`. Labels that contradict the limit by more than `MARGIN` keep their names: they show
neighbours with a hidden contact, and close objects of which one is above the other.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.relations import ADJACENT, NONE

BESIDE = "beside="
"""Inner class of pairs that the gap decides; no user's label ends with ``=``."""
MARGIN = 0.005
"""Metres by which a label must contradict the limit to keep its name; the noise of a gap is smaller."""
HIDDEN_EDGE = 0.002
"""Metres added to the limit, because a visible gap is wider than the distance between the surfaces."""
STEEP, SLOW = 0.0015, 0.004
"""Metres over which the shares change by e below and above the limit: the noise of a visible gap; hidden edges."""


def applies(vocabulary: Sequence[str], adjacent_gap: float | None) -> bool:
    """Whether the vocabulary has *adjacent* and *none*, and a limit is given."""
    return adjacent_gap is not None and {ADJACENT, NONE} <= set(vocabulary)


def inner_label(label: str, gap: float, adjacent_gap: float) -> str:
    """The class of a training pair: `BESIDE` where the gap explains its label."""
    explained = (label == ADJACENT and gap <= adjacent_gap + MARGIN) or (
        label == NONE and gap >= adjacent_gap - MARGIN
    )
    return BESIDE if explained else label


def resolve_beside(
    shares: dict[str, NDArray[np.float64]], gaps: NDArray[np.float64], adjacent_gap: float
) -> dict[str, NDArray[np.float64]]:
    """Shares without `BESIDE`, whose share goes to *adjacent* below the limit and to *none* above it."""
    outer = {name: share for name, share in shares.items() if name != BESIDE}
    beside = shares.get(BESIDE, np.zeros(len(gaps)))
    beyond = gaps - adjacent_gap - HIDDEN_EDGE
    close = 0.5 - 0.5 * np.tanh(beyond / np.where(beyond < 0, 2 * STEEP, 2 * SLOW))
    for name, part in ((ADJACENT, beside * close), (NONE, beside * (1 - close))):
        outer[name] = outer.get(name, np.zeros(len(gaps))) + part
    return outer
