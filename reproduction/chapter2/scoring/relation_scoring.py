"""Accuracy of perceived relations, exact with direction.

The thesis's label of a pair is a vector (on, adjacent); *both* has both components, *none* has neither (§2.4.1).
Here the direction counts as well: ``on(a, b)`` predicted for ``on(b, a)`` is wrong.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, NONE, ON, SYMMETRIC, PairLabel
from lifelore.perception.relations.relation import Relation

BORDER = 0.005
"""Metres. A noisy camera may see a gap so near `ADJACENT_GAP` on either side of it."""
CARRIED, BESIDE = frozenset({ON, BOTH}), frozenset({ADJACENT, BOTH})


@dataclass(frozen=True)
class JudgedPair:
    """A labelled pair, its predicted relation (None counts as *none*) and its visible gap, metres or infinite."""

    scene: str
    truth: PairLabel
    predicted: Relation | None
    gap: float

    @property
    def relation(self) -> str:
        """The predicted relation."""
        return self.predicted.relation if self.predicted else NONE

    @property
    def same_way(self) -> bool:
        """Whether the prediction names the pair in the truth's order, or has no order."""
        return self.relation in SYMMETRIC or self.predicted is None or self.predicted.a == self.truth.a

    @property
    def exact(self) -> bool:
        """The relation and its direction are right."""
        return self.relation == self.truth.relation and self.same_way

    @property
    def with_table(self) -> bool:
        """Whether one of the two is the table."""
        return TABLE in (self.truth.a, self.truth.b)

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
    """Each labelled pair of a scene beside its predicted relation; labels of confidence 1 are left out.

    `gaps` are the visible gaps of ``{a, b}``, metres, where better known than by `predicted`.
    """
    by_pair = {frozenset((relation.a, relation.b)): relation for relation in predicted}
    judged = []
    for label in truth:
        pair = frozenset((label.a, label.b))
        if label.confidence >= 2:
            relation = by_pair.get(pair)
            gap = (gaps or {}).get(pair, relation.gap if relation else np.inf)
            judged.append(JudgedPair(scene, label, relation, gap))
    return judged


def less_rate(share: Estimate, rate: float) -> Estimate:
    """A share less a known rate."""
    ends = (share.ci95[0] - rate, share.ci95[1] - rate) if share.ci95 else None
    return Estimate(share.value - rate, share.median - rate, ends, share.n)
