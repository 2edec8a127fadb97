"""`bench lived_relations`: labels beside forces, shares and differences by hand, and a short life."""

import numpy as np
import pytest

from benchmarks.perception import lived_relations
from benchmarks.perception.lived_relations import (
    LivedRound,
    bench_lived_relations,
    exact,
    judged_lesson,
    report,
)
from lifelore.agent.long_lived.families.pick_lessons import Lesson, TrayPairs
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import PairBelief, Relation


def lesson(label: PairLabel, **shares: float) -> Lesson:
    beliefs = (PairBelief(2, 3, 0.0, {name.replace("under", "~on"): share for name, share in shares.items()}),)
    # The gripper's numbers are not the cloud's: object 1 is labelled 2, and object 0 is labelled 3.
    return Lesson(TrayPairs(None, beliefs, {1: 2, 0: 3}), (label,))  # pyright: ignore[reportArgumentType]


CARRIES = np.array([[0.0, 0.0], [0.9, 0.0]])
"""Label 3 (object 0) carries label 2 (object 1)."""


@pytest.mark.parametrize(
    ("label", "believed", "judged"),
    [
        (PairLabel(2, 3, "on", 3), {"on": 0.4, "none": 0.6}, (True, False)),
        (PairLabel(2, 3, "both", 2), {"on": 1.0}, (True, True)),
        (PairLabel(3, 2, "on", 3), {"on": 0.6, "under": 0.4}, (False, True)),
        (PairLabel(2, 3, "adjacent", 2), {"under": 1.0}, (False, False)),
    ],
)
def test_labels_and_beliefs_are_judged_by_who_carries_whom(label, believed, judged):
    assert judged_lesson(lesson(label, **believed), CARRIES) == [judged]


def test_where_nobody_carries_both_may_be_right_though_the_relation_differs():
    assert judged_lesson(lesson(PairLabel(2, 3, "none", 2), adjacent=1.0), 0.04 * CARRIES) == [(True, True)]


def test_doubtful_labels_do_not_count():
    assert judged_lesson(lesson(PairLabel(2, 3, "on", 1), on=1.0), CARRIES) == []


def test_exact_minds_the_order_where_a_relation_has_one():
    assert exact(Relation(3, 2, "on", 0.9, 0.0), PairLabel(3, 2, "on"))
    assert not exact(Relation(2, 3, "on", 0.9, 0.0), PairLabel(3, 2, "on"))
    assert not exact(Relation(3, 2, "both", 0.9, 0.0), PairLabel(3, 2, "on"))
    assert exact(Relation(2, 3, "adjacent", 0.9, 0.0), PairLabel(3, 2, "adjacent"))


def test_shares_differences_and_goals_by_hand():
    rounds = [
        LivedRound(100, 80, 300, 200, 190, 180, 14, 4, 100, 80, 90),
        LivedRound(100, 60, 100, 100, 100, 98, 2, 0, 200, 170, 180),
    ]
    found = report(rounds)
    values = {row["name"]: row["value"] for row in found["rows"]}
    assert values["labelled pairs"] == 2
    assert values["labelled pairs that a model learns from"] == 1.5
    assert values["right about carrying, labels"] == pytest.approx(0.975)
    assert values["right about carrying, labels less perception"] == pytest.approx((0.05 + 0.02) / 2)
    assert values["labels that correct perception"] == 8
    assert values["exact relation, model of the life less shipped"] == pytest.approx((-0.1 - 0.05) / 2)
    assert [goal["met"] for goal in found["goals"]] == [True, False]
    assert {row["n"] for row in found["rows"]} == {2}


@pytest.mark.slow
@pytest.mark.sim
def test_a_short_life(monkeypatch, tmp_path):
    pytest.importorskip("mujoco", reason="needs the extra sim")
    monkeypatch.setattr(lived_relations, "TASKS", 6)
    monkeypatch.setattr(lived_relations, "SCENES", 4)
    told = []
    found = bench_lived_relations(1, lambda *args: told.append(args), tmp_path)
    values = {row["name"]: row["value"] for row in found["rows"]}
    assert 0 < values["labelled pairs that a model learns from"] <= values["labelled pairs"]
    assert 0.5 < values["right about carrying, labels"] <= 1
    assert values["pairs of simulated scenes"] > 0
    assert told == [(1, 1, "life 1")]
    # A bench that was stopped does not live a finished life again.
    monkeypatch.setattr(lived_relations, "lived_round", None)
    assert bench_lived_relations(1, lambda *args: None, tmp_path) == found
