"""*adjacent* by an explicit length: things beside one another are adjacent up to a visible gap, none beyond it.

The limit is a parameter with a meaning, not something a handful of examples could teach (gaps of hand-labelled
neighbours and strangers overlap from 20 to 30 mm). So in training both are one class, *beside*. Labels that
contradict the limit by more than `MARGIN` teach what a gap cannot show: neighbours whose contact is hidden, and
things close together of which one is above the other; those keep their names.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.relations import ADJACENT, NONE

BESIDE = "beside="
"""The inner class of what the gap decides; no user's label ends so."""
MARGIN = 0.005
"""Metres by which a label must contradict the limit to be more than noise of the gap."""
SOFTNESS = 0.002
"""Metres over which the answer turns: the noise of a visible gap."""


def applies(vocabulary: Sequence[str], adjacent_gap: float | None) -> bool:
    """Whether these relations have neighbours and strangers to tell apart, and a limit is given."""
    return adjacent_gap is not None and {ADJACENT, NONE} <= set(vocabulary)


def inner_label(label: str, gap: float, adjacent_gap: float) -> str:
    """The class that a pair trains: `BESIDE` where the gap explains its label."""
    explained = (label == ADJACENT and gap <= adjacent_gap + MARGIN) or (
        label == NONE and gap >= adjacent_gap - MARGIN
    )
    return BESIDE if explained else label


def decided(
    shares: dict[str, NDArray[np.float64]], gaps: NDArray[np.float64], adjacent_gap: float
) -> dict[str, NDArray[np.float64]]:
    """Shares without `BESIDE`: it goes to *adjacent* below the limit and to *none* above it."""
    outer = {name: share for name, share in shares.items() if name != BESIDE}
    beside = shares.get(BESIDE, np.zeros(len(gaps)))
    close = 0.5 - 0.5 * np.tanh((gaps - adjacent_gap) / (2 * SOFTNESS))
    for name, part in ((ADJACENT, beside * close), (NONE, beside * (1 - close))):
        outer[name] = outer.get(name, np.zeros(len(gaps))) + part
    return outer
