"""The benchmark of types that change, small: its users, its pairing, and what a hazard is for."""

import numpy as np
import pytest

from benchmarks import bench
from benchmarks.interaction import changing_types as case


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(case, "USERS", 6)
    monkeypatch.setattr(case, "HAZARDS", (0.0, 0.002))


def test_users_who_change_get_another_type_halfway(small):
    changing, staying = (case.types_of_users(kind, 5, 3) for kind in (case.CHANGING, case.STAYING))
    half = case.CHANGE_AFTER
    assert np.array_equal(changing[:, :half], staying[:, :half])
    assert (staying == staying[:, :1]).all()
    assert (changing[:, half:] == changing[:, half:][:, :1]).all()
    assert (changing[:, half] != changing[:, half - 1]).all()


def test_rows_goals_and_the_use_of_a_hazard(small):
    said = []
    document = bench("changing_types", repeats=1, progress=lambda *at: said.append(at[:2]))
    assert said == [(done, 8) for done in range(1, 9)]
    rows = {row["name"]: row for row in document["rows"]}
    assert len(rows) == len(document["rows"]) == 2 * 2 * (2 + 3)
    assert all(row["n"] == 6 for row in rows.values())
    changed = "exact models, type changes once, hazard"
    assert rows[f"stuck in the end, {changed} 0"]["value"] == 1.0
    assert rows[f"stuck in the end, {changed} 0.002"]["value"] == 0.0
    more = rows[f"regret more than static types, {changed} 0.002"]["value"]
    of = [rows[f"regret of 100 episodes, {changed} {hazard}"] for hazard in ("0", "0.002")]
    assert more == pytest.approx(of[1]["value"] - of[0]["value"])
    assert of[1]["ratio"] == pytest.approx(of[1]["value"] / of[0]["value"])
    assert document["goals"][0] == {
        "name": f"stuck in the end, {changed} 0.002", "goal": "<= 0.05", "measured": 0.0, "met": True
    }  # fmt: skip
    assert [goal["goal"] for goal in document["goals"]] == ["<= 0.05", "<= 0.0", "<= 0.0"]
