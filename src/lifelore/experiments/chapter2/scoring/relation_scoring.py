"""Accuracy of perceived relations: exact with direction, by component and by class, each with an interval.

The thesis's label of a pair is a vector (on, adjacent); *both* has both components, *none* has neither (§2.4.1).
Here the direction counts as well: ``on(a, b)`` said of ``on(b, a)`` is wrong, exactly and in its `on` component.
Pairs of one scene share its camera, its noise and its neighbours, so intervals resample scenes, not pairs.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, CORE_RELATIONS, NONE, ON, SYMMETRIC, PairLabel
from lifelore.core.streams import stream
from lifelore.experiments.engine.estimates import UNMEASURED
from lifelore.perception.relations.relation import Relation

BORDER = 0.005
"""Metres. A noisy camera may see a gap so near `ADJACENT_GAP` on either side of it."""
HIDDEN = 0.03
"""Metres. A contact whose visible gap is larger lies on hidden faces."""
RESAMPLES = 1000
CARRIED, BESIDE = frozenset({ON, BOTH}), frozenset({ADJACENT, BOTH})


@dataclass(frozen=True)
class JudgedPair:
    """A labelled pair and its predicted relation.

    Parameters
    ----------
    scene : str
    truth : PairLabel
    said : Relation, optional
        The prediction; None where there is none, which counts as the relation *none*.
    gap : float
        Visible gap, metres; infinite where unknown.
    """

    scene: str
    truth: PairLabel
    said: Relation | None
    gap: float

    @property
    def relation(self) -> str:
        """The predicted relation."""
        return self.said.relation if self.said else NONE

    @property
    def same_way(self) -> bool:
        """Whether the prediction names the pair in the truth's order, or has no order."""
        return self.relation in SYMMETRIC or self.said is None or self.said.a == self.truth.a

    @property
    def exact(self) -> bool:
        """The relation and its direction are right."""
        return self.relation == self.truth.relation and self.same_way

    @property
    def on_right(self) -> bool:
        """The component `on` is right, direction included."""
        carried = self.truth.relation in CARRIED
        return carried == (self.relation in CARRIED) and (not carried or self.same_way)

    @property
    def adjacent_right(self) -> bool:
        """The component `adjacent` is right."""
        return (self.truth.relation in BESIDE) == (self.relation in BESIDE)

    @property
    def with_table(self) -> bool:
        """Whether one of the two is the table."""
        return TABLE in (self.truth.a, self.truth.b)

    @property
    def border(self) -> bool:
        """Whether a gap near the limit alone decides between *adjacent* and *none*."""
        return self.truth.relation in SYMMETRIC and abs(self.gap - ADJACENT_GAP) <= BORDER

    @property
    def hidden(self) -> bool:
        """Whether the pair is near or in contact although its visible gap is large."""
        return self.truth.relation != NONE and HIDDEN < self.gap < np.inf


@dataclass(frozen=True)
class RelationScore:
    """Shares in [0, 1] with 95 % intervals; `recall` by class, `n` of each Estimate counts pairs.

    `macro_f1` is the mean over the classes that occur in the truth.
    """

    pairs: int
    scenes: int
    exact: Estimate
    on: Estimate
    adjacent: Estimate
    macro_f1: Estimate
    recall: dict[str, Estimate]


def judged_scene(
    scene: str,
    truth: Sequence[PairLabel],
    said: Sequence[Relation],
    gaps: Mapping[frozenset[int], float] | None = None,
    least_confidence: int = 2,
) -> list[JudgedPair]:
    """Each labelled pair of a scene beside its predicted relation.

    Parameters
    ----------
    gaps : mapping, optional
        Visible gap of ``{a, b}`` where better known than by `said`, metres.
    least_confidence : int
        Labels below it are left out.
    """
    by_pair = {frozenset((relation.a, relation.b)): relation for relation in said}
    judged = []
    for label in truth:
        pair = frozenset((label.a, label.b))
        if label.confidence >= least_confidence:
            relation = by_pair.get(pair)
            gap = (gaps or {}).get(pair, relation.gap if relation else np.inf)
            judged.append(JudgedPair(scene, label, relation, gap))
    return judged


def score(judged: Sequence[JudgedPair]) -> RelationScore | None:
    """The score of some pairs; None of none."""
    if not judged:
        return None
    scenes = sorted({pair.scene for pair in judged})
    classes = [name for name in _classes(judged) if any(pair.truth.relation == name for pair in judged)]
    return RelationScore(
        pairs=len(judged),
        scenes=len(scenes),
        exact=share(judged, lambda pair: pair.exact),
        on=share(judged, lambda pair: pair.on_right),
        adjacent=share(judged, lambda pair: pair.adjacent_right),
        macro_f1=_macro_f1(judged, scenes, classes),
        recall={
            name: share([pair for pair in judged if pair.truth.relation == name], lambda pair: pair.exact)
            for name in classes
        },
    )


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

    Parameters
    ----------
    right, asked : (n,)
        Of each scene how many answers are right, and how many there are.
    interval_where_all_agree : callable, optional
        ``(right, n)`` → (low, high), where no resample differs; default: Wilson's.
    """
    right, asked = np.asarray(right, float), np.asarray(asked, float)
    n_right, n = int(right.sum()), int(asked.sum())
    if not n:
        return UNMEASURED
    found = ratio_estimate(right, asked)
    interval = found.ci95 if 0 < n_right < n else None
    return Estimate(found.value, found.median, interval or (interval_where_all_agree or wilson)(n_right, n), n)


def less_rate(share: Estimate, rate: float) -> Estimate:
    """A share less a known rate."""
    ends = (share.ci95[0] - rate, share.ci95[1] - rate) if share.ci95 else None
    return Estimate(share.value - rate, share.median - rate, ends, share.n)


def score_row(scored: RelationScore, keys: Sequence[str] = ("exact", "on", "adjacent", "macro_f1")) -> dict:
    """Estimates of a score as plain data, and its recalls."""
    recall = {name: number.to_dict() for name, number in scored.recall.items()}
    return {**{key: getattr(scored, key).to_dict() for key in keys}, "recall": recall}


def wilson(right: int, n: int, z: float = 1.959964) -> tuple[float, float]:
    """Wilson's 95 % score interval of a share, within [0, 1]; n ≥ 1."""
    p = right / n
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return float(max(middle - half, 0.0)), float(min(middle + half, 1.0))


def difference(first: Sequence[JudgedPair], second: Sequence[JudgedPair]) -> Estimate:
    """Exact share of `first` less that of `second`, on the same pairs; scenes resampled (percentiles).

    Both hold the same labelled pairs in the same order.
    """
    names = sorted({pair.scene for pair in first})
    at = {name: number for number, name in enumerate(names)}
    rows = np.zeros((len(names), 2))
    for one, other in zip(first, second, strict=True):
        rows[at[one.scene]] += (float(one.exact) - float(other.exact), 1.0)
    drawn = _draws(len(names)) @ rows
    value = float(rows[:, 0].sum() / rows[:, 1].sum())
    return Estimate(value, value, _percentiles(drawn[:, 0] / drawn[:, 1]), len(first))


def _classes(judged: Iterable[JudgedPair]) -> list[str]:
    """The core relations in their order, then any others by name."""
    named = {pair.truth.relation for pair in judged}
    return [*CORE_RELATIONS, *sorted(named - set(CORE_RELATIONS))]


def _macro_f1(judged: Sequence[JudgedPair], scenes: list[str], classes: list[str]) -> Estimate:
    at = {name: number for number, name in enumerate(scenes)}
    # Of each scene and class: right, said, true.
    counts = np.zeros((len(scenes), len(classes), 3))
    for pair in judged:
        for number, name in enumerate(classes):
            of = pair.truth.relation == name
            counts[at[pair.scene], number] += (of and pair.exact, pair.relation == name, of)
    value = float(_mean_f1(counts.sum(axis=0)[None])[0])
    resampled = _mean_f1(np.tensordot(_draws(len(scenes)), counts, axes=1))
    return Estimate(value, value, _percentiles(resampled), len(judged))


def _mean_f1(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean over classes of 2 right / (said + true), from counts (n, classes, 3); 0 for a class that is neither."""
    right, said, true = np.moveaxis(counts, -1, 0)
    return (2 * right / np.maximum(said + true, 1)).mean(axis=1)


def _draws(n: int) -> NDArray[np.float64]:
    """How often each of `n` scenes is drawn in each resample, ``(RESAMPLES, n)``; the same for the same n."""
    return stream(n, "scenes resampled").multinomial(n, np.full(n, 1 / n), size=RESAMPLES).astype(float)


def _percentiles(values: NDArray[np.float64]) -> tuple[float, float]:
    low, high = np.quantile(values, [0.025, 0.975])
    return float(low), float(high)
