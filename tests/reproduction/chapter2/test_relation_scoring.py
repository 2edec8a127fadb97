"""Scores of relations: directions and pairs at the border, worked by hand."""

import pytest

from lifelore.core.metrics import Estimate
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.scoring.relation_scoring import JudgedPair, judged_scene, less_rate


def judged(truth: str, said: str | None, *, way=(2, 3), gap=0.001) -> JudgedPair:
    relations = [] if said is None else [Relation(*way, said, 1.0, gap)]
    return judged_scene("a", [PairLabel(2, 3, truth)], relations)[0]


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
    assert (second.exact, second.gap) == (True, 0.07)
    # A gap that is known better than by looking counts.
    assert judged_scene("s", truth, said, {frozenset((2, 3)): 0.001})[0].gap == 0.001


def test_a_share_less_a_rate_moves_its_interval():
    less = less_rate(Estimate(0.9, 0.8, (0.7, 1.0), 5), 0.5)
    assert (less.value, less.median, less.n) == (pytest.approx(0.4), pytest.approx(0.3), 5)
    assert less.ci95 == pytest.approx((0.2, 0.5))
