"""Relations of pairs by the thesis's method: votes of the displacements between contact points.

Thesis: §2.3.5, Alg. 1. A pair with displacements voting *on* and others *adjacent* is *both*, their union;
otherwise the relation with most votes wins. The share of agreeing votes is the confidence.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from numbers import Integral, Real

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.relations import ADJACENT, BOTH, ON, PairLabel
from lifelore.perception.pairs.directed_label import mirrored, pair_class
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.displacement import short_enough, votes

UNIONS = {frozenset({ON, ADJACENT}): BOTH, frozenset({"~" + ON, ADJACENT}): "~" + BOTH}
"""The union of two labels of one pair."""
MOST_NEIGHBOURS = 1000
"""Largest k; more cost time and memory."""


@dataclass(frozen=True)
class NeighbourSettings:
    """Settings of the votes.

    Parameters
    ----------
    k : int
        Number of neighbours that vote, 1 to `MOST_NEIGHBOURS`; the thesis's 4.
    omega : float, optional
        Largest displacement in training (the thesis's threshold ω), metres, above 0; None uses all.
    weights : {"uniform", "distance"}
        Equal votes, or votes by the inverse of the distance (the thesis's alternative to ω).

    Raises
    ------
    InputError
        A setting breaks its rule.
    """

    k: int = 4
    omega: float | None = None
    weights: str = "uniform"

    def __post_init__(self) -> None:
        k, omega = self.k, self.omega
        if isinstance(k, bool) or not isinstance(k, Integral) or not 1 <= int(k) <= MOST_NEIGHBOURS:
            raise InputError(f"k must be a whole number from 1 to {MOST_NEIGHBOURS}, got {k!r}")
        if omega is not None and (
            isinstance(omega, bool) or not isinstance(omega, Real) or not (omega > 0 and isfinite(omega))
        ):
            raise InputError(f"omega must be metres above 0, or None to learn from all, got {omega!r}")
        if self.weights not in ("uniform", "distance"):
            raise InputError(f"weights must be 'uniform' or 'distance', got {self.weights!r}")


@dataclass(frozen=True, eq=False)
class DisplacementRelations:
    """Labelled displacements, those of object pairs or those with the table.

    Parameters
    ----------
    classes : tuple of str
    displacements : (n, 3) float64
        Metres.
    codes : (n,) int64
        Class of each.
    k : int
    weights : {"uniform", "distance"}
    """

    classes: tuple[str, ...]
    displacements: NDArray[np.float64]
    codes: NDArray[np.int64]
    k: int
    weights: str

    def shares(self, asked: NDArray[np.float64]) -> dict[str, float]:
        """Probability of each class for a pair with these displacements ``(m, 3)``, m ≥ 1."""
        found = votes(self.displacements, self.codes, len(self.classes), asked, self.k, self.weights)
        mean = dict(zip(self.classes, found.mean(axis=0).tolist(), strict=True))
        said = frozenset(self.classes[at] for at in found.argmax(axis=1))
        united = UNIONS.get(said)
        if united in self.classes:
            # Votes for the parts count for their union.
            mean[united] += sum(mean[name] for name in said)
            mean.update(dict.fromkeys(said, 0.0))
        return mean


def fit_displacements(
    scenes: Sequence[ScenePairs],
    truths: Sequence[Sequence[PairLabel]],
    symmetric: frozenset[str],
    least_confidence: int,
    with_table: bool,
    options: NeighbourSettings,
) -> DisplacementRelations | None:
    """All displacements of all labelled pairs, each with its pair's label, in both orders among objects."""
    rows, names = [], []
    for scene, truth in zip(scenes, truths, strict=True):
        said = scene.labels(truth, least_confidence)
        for at in np.flatnonzero(scene.with_table == with_table):
            if said[at]:
                name = pair_class(said[at], int(scene.features.pairs[2 * at, 0]), symmetric)
                rows.append(scene.displacements[at])
                names += [name] * len(rows[-1])
                if not with_table:
                    rows.append(-scene.displacements[at])
                    names += [mirrored(name, symmetric)] * len(rows[-1])
    if not rows:
        return None
    known = np.concatenate(rows)
    classes, codes = np.unique(np.array(names, str), return_inverse=True)
    chosen = short_enough(known, codes, options.omega)
    return DisplacementRelations(
        tuple(map(str, classes)), known[chosen], codes[chosen], options.k, options.weights
    )
