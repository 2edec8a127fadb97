"""The benchmark of perfect information, small: its rows, its pairing, and where the rule cannot fail."""

import pytest

from benchmarks import bench
from benchmarks.interaction import perfect_information as case
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN
from reproduction.own.o_01_default_rule.worlds import EQUAL, GOLF, TABLES


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(case, "WORLDS", (GOLF, TABLES))
    monkeypatch.setattr(case, "NOISES", (EQUAL,))
    monkeypatch.setattr(case, "TASKS", 4)
    monkeypatch.setattr(case, "EPISODES", 12)


def test_rows_and_goals(small):
    done = []
    document = bench("perfect_information", repeats=3, progress=lambda *at: done.append(at[:2]))
    assert done == [(number, 18) for number in range(1, 19)]
    rows = {row["name"]: row for row in document["rows"]}
    assert len(rows) == len(document["rows"]) == 2 * (5 * 2 + 4) + 4 * 2 + 3
    for models in (EXACT, LEARNT, UNCERTAIN):
        relative = [
            row["value"] for name, row in rows.items() if name.startswith("relative") and f"{models} mod" in name
        ]
        # In each world the best rule has 1, and the mean of two worlds is at least that.
        assert min(relative) >= 1
        stuck = [row["value"] for name, row in rows.items() if name.startswith("stuck") and f"{models} m" in name]
        assert min(stuck) >= 0
        for other in (case.ONCE, case.DIRECTED, case.IMPROVEMENT):
            ratio = rows[f"regret of {case.PERFECT} / {other}, {models} models"]
            of = [rows[f"relative regret, {name}, {models} models"]["value"] for name in (case.PERFECT, other)]
            assert ratio["value"] == pytest.approx(of[0] / of[1])
            assert ratio["n"] == 3
    for goal, models in zip(document["goals"], (EXACT, LEARNT), strict=True):
        assert goal["name"] == f"regret of {case.PERFECT} / {case.GRADIENT}, {models} models"
        assert goal["met"] == (goal["measured"] <= 1.1)


def test_rules_meet_the_same_tasks_and_a_rule_repeats_itself(small):
    at = (TABLES, EQUAL, LEARNT)
    assert case.played(at, case.PERFECT, 1) == case.played(at, case.PERFECT, 1) != case.played(at, case.PERFECT, 2)
