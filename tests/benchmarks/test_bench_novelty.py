"""`bench novelty`: its parts by hand, and a tiny run of every case."""

import numpy as np
import pytest

from benchmarks import BENCHES
from benchmarks.interaction import novelty
from benchmarks.interaction.novelty_cases import EXACT, LEARNT, STUDENT, cases, golf, surveillance


def test_the_auc_counts_pairs_and_ties_by_half():
    known, unseen = np.array([1.0, 2.0, 3.0]), np.array([2.0, 5.0])
    by_pairs = np.mean([(u > k) + 0.5 * (u == k) for u in unseen for k in known])
    assert novelty.auc(known, unseen) == pytest.approx(by_pairs)


def test_held_out_targets_are_no_types_of_the_library():
    setting = surveillance(np.random.default_rng(0), EXACT)
    assert (setting.library.n_types, setting.library.n_policies) == (60, 68)
    held = setting.unseen["held-out targets"](np.random.default_rng(1), 200)
    types = setting.library.performance.mean
    for row in np.unique(held.mean, axis=0):
        assert not (row == types).all(axis=1).any()
    known = setting.known(np.random.default_rng(1), 50)
    assert all((row == types).all(axis=1).any() for row in known.mean)


def test_unseen_holes_lie_apart_from_the_training_holes():
    setting = golf(np.random.default_rng(0), EXACT)
    tasks = setting.unseen["other holes"](np.random.default_rng(1), 300)
    assert len(tasks.cumulative) == 300
    assert setting.signal_count is None
    assert golf(np.random.default_rng(0), LEARNT).signal_count == 13.5


def test_measures_of_a_case_follow_from_its_round_alone(monkeypatch):
    for name, n in (("CALIBRATION_TASKS", 2000), ("KNOWN_TASKS", 100), ("UNSEEN_TASKS", 50), ("HORIZON", 30)):
        monkeypatch.setattr(novelty, name, n)
    case = next(case for case in cases() if case.name == f"surveillance, {STUDENT}")
    first, again = novelty.measure(case, 3), novelty.measure(case, 3)
    assert first == again
    assert first["held-out targets: AUC of joined at 30"] > 0.7


def test_every_case_gives_rows_and_the_reserve_gives_goals(monkeypatch):
    for name, n in (("CALIBRATION_TASKS", 2000), ("KNOWN_TASKS", 20), ("UNSEEN_TASKS", 10)):
        monkeypatch.setattr(novelty, name, n)
    some = [case for case in cases() if not case.name.endswith("improvement")]
    monkeypatch.setattr(novelty, "cases", lambda: some)
    monkeypatch.setattr(novelty, "update_cost", lambda repeats: {"rows": [], "goals": []})
    done = []
    document = novelty.bench_novelty(1, lambda *at: done.append(at[:2]))
    assert "novelty" in BENCHES
    assert done[-1] == (len(some), len(some))
    names = [row["name"] for row in document["rows"]]
    for case in some:
        assert f"{case.name}: false alarms at 1%" in names
    assert all(
        0 <= row["value"] <= 1 for row in document["rows"] if row["unit"] in ("share", "AUC", "probability")
    )
    assert {goal["goal"] for goal in document["goals"]} == {"0.008 to 0.012", "0.04 to 0.06"}
    assert len(document["goals"]) == 2 * sum(case.name.startswith("surveillance") for case in some)


def test_rows_carry_means_and_intervals_over_libraries():
    row = novelty._row("golf", "false alarms at 1%", [0.01, 0.02, 0.03, np.nan])
    assert (row["value"], row["libraries"], row["unit"]) == (0.02, 4, "share")
    assert row["ci95"][0] < 0.02 < row["ci95"][1]
    assert novelty._row("golf", "other holes: delay at 1%", [np.nan])["value"] is None


def test_the_cost_is_measured_in_pairs():
    found = novelty.update_cost(1)
    plain, watched = found["rows"]
    assert watched["ratio"] == pytest.approx(watched["value"] / plain["value"])
