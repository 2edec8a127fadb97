"""Scores of relations: components, directions, classes and intervals, worked by hand."""

import pytest
from scipy.stats import binomtest

from lifelore.core.metrics import Estimate
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.scoring.relation_scoring import (
    JudgedPair,
    difference,
    judged_scene,
    less_rate,
    share,
    share_over_scenes,
    wilson,
)


def judged(truth: str, said: str | None, *, way=(2, 3), gap=0.001, scene="a", truth_way=(2, 3)) -> JudgedPair:
    relation = None if said is None else Relation(*way, said, 1.0, gap)
    return JudgedPair(scene, PairLabel(*truth_way, truth), relation, gap)


@pytest.mark.parametrize(
    ("truth", "said", "way", "exact"),
    [
        ("on", "on", (2, 3), True),
        ("on", "on", (3, 2), False),
        ("on", "both", (2, 3), False),
        ("on", None, (2, 3), False),
        ("adjacent", "adjacent", (3, 2), True),
        ("both", "both", (2, 3), True),
        ("both", "both", (3, 2), False),
        ("none", "none", (3, 2), True),
        ("none", None, (2, 3), True),
        ("none", "on", (2, 3), False),
    ],
)
def test_the_direction_counts(truth, said, way, exact):
    assert judged(truth, said, way=way).exact is exact


def test_pairs_at_the_border():
    assert judged("none", "none", gap=0.0270).border
    assert not judged("none", "none", gap=0.0280).border
    assert judged("adjacent", "none", gap=0.0180).border
    assert not judged("on", "none", gap=0.0200).border


def test_a_scene_is_judged_pair_by_pair_without_the_doubtful():
    truth = [PairLabel(2, 3, "on"), PairLabel(4, 3, "adjacent", 1), PairLabel(2, 4, "none", 2)]
    said = [Relation(3, 2, "on", 0.9, 0.004), Relation(3, 4, "adjacent", 0.9, 0.01)]
    first, second = judged_scene("s", truth, said, {frozenset((2, 4)): 0.07})
    assert (first.exact, first.gap) == (False, 0.004)
    assert (second.exact, second.predicted, second.gap) == (True, None, 0.07)
    # A gap that is known better than by looking counts.
    assert judged_scene("s", truth, said, {frozenset((2, 3)): 0.001})[0].gap == 0.001


@pytest.mark.parametrize(("right", "n"), [(0, 5), (3, 10), (10, 10), (47, 52)])
def test_wilsons_interval_is_scipys(right, n):
    expected = binomtest(right, n).proportion_ci(0.95, method="wilson")
    assert wilson(right, n) == pytest.approx((expected.low, expected.high), abs=1e-6)


def test_intervals_resample_scenes():
    # Ten scenes of ten pairs that are right or wrong together carry no more than ten answers do.
    together = [judged("on", "on" if s % 2 else "none", scene=str(s)) for s in range(10) for _ in range(10)]
    apart = [judged("on", "on" if p % 2 else "none", scene=str(10 * s + p)) for s in range(10) for p in range(10)]
    wide, narrow = share(together, lambda p: p.exact), share(apart, lambda p: p.exact)
    assert wide.value == narrow.value == 0.5
    assert wide.n == narrow.n == 100
    assert wide.ci95 is not None
    assert narrow.ci95 is not None
    # Standard errors of 10 and of 100 fair answers are 0.158 and 0.05.
    assert wide.ci95[1] - wide.ci95[0] > 2 * (narrow.ci95[1] - narrow.ci95[0])


def test_difference_by_hand():
    first = [judged("on", "on", scene=str(s)) for s in range(8)]
    second = [judged("on", "none" if s < 2 else "on", scene=str(s)) for s in range(8)]
    lost = difference(first, second)
    assert lost.value == pytest.approx(0.25)
    assert lost.ci95 is not None
    assert lost.ci95[0] <= 0.25 <= lost.ci95[1]
    assert difference(first, first).value == 0
    assert difference(first, first).ci95 == (0.0, 0.0)


def test_a_share_without_spread_has_wilsons_interval_and_of_nothing_none():
    assert share_over_scenes([1, 1, 1], [1, 1, 1]).ci95 == (pytest.approx(0.4385, abs=1e-4), 1.0)
    assert share_over_scenes([1, 1], [1, 1], lambda right, n: (right / 4, n / 2)).ci95 == (0.5, 1.0)
    assert share_over_scenes([], []).n == 0


def test_a_share_less_a_rate_moves_its_interval():
    less = less_rate(Estimate(0.9, 0.8, (0.7, 1.0), 5), 0.5)
    assert (less.value, less.median, less.n) == (pytest.approx(0.4), pytest.approx(0.3), 5)
    assert less.ci95 == pytest.approx((0.2, 0.5))
