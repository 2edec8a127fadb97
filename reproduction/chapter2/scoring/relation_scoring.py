"""Accuracy of perceived relations, exact with direction.

The thesis's label of a pair is a vector (on, adjacent); *both* has both components, *none* has neither (§2.4.1).
Here the direction counts as well: ``on(a, b)`` predicted for ``on(b, a)`` is wrong.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, NONE, ON, SYMMETRIC, PairLabel
from lifelore.perception.relations.relation import Relation

BORDER = 0.005
"""Metres. A noisy camera may see a gap so near `ADJACENT_GAP` on either side of it."""
CARRIED, BESIDE = frozenset({ON, BOTH}), frozenset({ADJACENT, BOTH})


class JudgedPair(NamedTuple):
    """A labelled pair: whether the predicted relation and its direction are right, and its visible gap.

    The gap is in metres, infinite where it is unknown.
    """

    scene: str
    truth: PairLabel
    exact: bool
    gap: float

    @property
    def border(self) -> bool:
        """Whether a gap near the limit alone decides between *adjacent* and *none*."""
        return self.truth.relation in SYMMETRIC and abs(self.gap - ADJACENT_GAP) <= BORDER


def judged_scene(
    scene: str,
    truth: Sequence[PairLabel],
    predicted: Sequence[Relation],
    gaps: Mapping[frozenset[int], float] | None = None,
) -> list[JudgedPair]:
    """Each labelled pair of a scene judged by its predicted relation; labels of confidence 1 are left out.

    A pair without a prediction counts as *none*. `gaps` are the visible gaps of ``{a, b}``, metres, where better
    known than by `predicted`.
    """
    by_pair = {frozenset((relation.a, relation.b)): relation for relation in predicted}
    judged = []
    for label in truth:
        pair = frozenset((label.a, label.b))
        if label.confidence >= 2:
            found = by_pair.get(pair, Relation(label.a, label.b, NONE, 1.0, np.inf))
            same_way = found.relation in SYMMETRIC or found.a == label.a
            gap = (gaps or {}).get(pair, found.gap)
            judged.append(JudgedPair(scene, label, found.relation == label.relation and same_way, gap))
    return judged


def less_rate(share: Estimate, rate: float) -> Estimate:
    """A share less a known rate."""
    ends = (share.ci95[0] - rate, share.ci95[1] - rate) if share.ci95 else None
    return Estimate(share.value - rate, share.median - rate, ends, share.n)
