"""Accuracy of perceived relations, exact with direction, with an interval.

The thesis's label of a pair is a vector (on, adjacent); *both* has both components, *none* has neither (§2.4.1).
Here the direction counts as well: ``on(a, b)`` predicted for ``on(b, a)`` is wrong.
Pairs of one scene share its camera, its noise and its neighbours, so intervals resample scenes, not pairs.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.stats import binomtest

from lifelore.core.intervals import percentile_interval
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, NONE, ON, SYMMETRIC, PairLabel
from lifelore.core.streams import stream
from lifelore.perception.relations.relation import Relation
from reproduction.engine.estimates import UNMEASURED

BORDER = 0.005
"""Metres. A noisy camera may see a gap so near `ADJACENT_GAP` on either side of it."""
RESAMPLES = 1000
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


def share(judged: Sequence[JudgedPair], right: Callable[[JudgedPair], bool]) -> Estimate:
    """Share of pairs that are right; scenes resampled (BCa), or Wilson's interval where all scenes agree."""
    by_scene: dict[str, list[bool]] = {}
    for pair in judged:
        by_scene.setdefault(pair.scene, []).append(right(pair))
    counts = np.array([(sum(answers), len(answers)) for answers in by_scene.values()], float)
    return share_over_scenes(counts[:, 0], counts[:, 1])


def share_over_scenes(
    right: ArrayLike,
    asked: ArrayLike,
    interval_where_all_agree: Callable[[int, int], tuple[float, float]] | None = None,
) -> Estimate:
    """Share of right answers, scenes resampled (BCa); `UNMEASURED` of none.

    `right` and `asked` ``(n,)`` count the right answers and all answers of each scene. Where all answers agree, no
    resample differs, and ``interval_where_all_agree(right, n)`` is the interval; default: Wilson's.
    """
    right, asked = np.asarray(right, float), np.asarray(asked, float)
    n_right, n = int(right.sum()), int(asked.sum())
    if not n:
        return UNMEASURED
    found = ratio_estimate(right, asked)
    interval = found.ci95 if found.ci95 and found.ci95[0] < found.ci95[1] else None
    return Estimate(found.value, found.median, interval or (interval_where_all_agree or wilson)(n_right, n), n)


def less_rate(share: Estimate, rate: float) -> Estimate:
    """A share less a known rate."""
    ends = (share.ci95[0] - rate, share.ci95[1] - rate) if share.ci95 else None
    return Estimate(share.value - rate, share.median - rate, ends, share.n)


def wilson(right: int, n: int) -> tuple[float, float]:
    """Wilson's 95 % score interval of a share, within [0, 1]; n ≥ 1."""
    interval = binomtest(right, n).proportion_ci(0.95, method="wilson")
    return float(interval.low), float(interval.high)


def difference(
    first: Sequence[JudgedPair],
    second: Sequence[JudgedPair],
    right: Callable[[JudgedPair], bool] = lambda pair: pair.exact,
) -> Estimate:
    """Share of right answers of `first` less that of `second`, on the same pairs; scenes resampled (percentiles).

    Both hold the same labelled pairs in the same order.
    """
    differences = [(float(right(a)) - float(right(b)), 1.0) for a, b in zip(first, second, strict=True)]
    sums = _sums_by_scene(first, differences)
    drawn = _draws(len(sums)) @ sums
    value = float(sums[:, 0].sum() / sums[:, 1].sum())
    return Estimate(value, value, percentile_interval(drawn[:, 0] / drawn[:, 1]), len(first))


def _sums_by_scene(judged: Sequence[JudgedPair], numbers: ArrayLike) -> NDArray[np.float64]:
    """Sums of the numbers of pairs ``(pairs, …)`` over the pairs of each scene ``(scenes, …)``, scenes by name."""
    names, at = np.unique([pair.scene for pair in judged], return_inverse=True)
    each = np.asarray(numbers, float)
    sums = np.zeros((len(names), *each.shape[1:]))
    np.add.at(sums, at, each)
    return sums


def _draws(n: int) -> NDArray[np.float64]:
    """How often each of `n` scenes is drawn in each resample, ``(RESAMPLES, n)``; the same for the same n."""
    return stream(n, "scenes resampled").multinomial(n, np.full(n, 1 / n), size=RESAMPLES).astype(float)
