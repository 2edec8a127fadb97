"""`bench tabletop_lives`: shares, differences and goals by hand, the figure, and one short round."""

import numpy as np
import pytest

from benchmarks.lives import tabletop_lives
from benchmarks.lives.tabletop_lives import (
    INFORMED,
    LIVING_AGENTS,
    N_TASKS,
    RAW,
    LifeResult,
    curve,
    lived_round,
    report,
)
from lifelore.core.metrics import mean_estimate
from reproduction.engine.cell_store import CellStore


def result(first, spills=0.0, n_types=3):
    n = 2 * N_TASKS
    best = np.full(n, 8.0)
    alarms, met = np.zeros(n), np.arange(n) % 40
    alarms[[N_TASKS, N_TASKS + 3]] = 1  # the types of these tasks were met in no task, and in three tasks
    return LifeResult(np.full(n, first), np.full(n, 8.0), best, np.full(n, spills), alarms, met, n_types)


def lives(n=4):
    firsts = {
        "full": 7.0,
        "no-perception": 4.0,
        "no-prior": 6.0,
        "no-reuse": 5.0,
        "scratch": 0.0,
        RAW: 6.5,
        INFORMED: 7.2,
    }
    return [
        {agent: result(firsts[agent] + 0.1 * i, float(agent == "scratch")) for agent in firsts} for i in range(n)
    ]


def test_shares_differences_and_goals_by_hand():
    found = report([lives()[:2], lives()[2:]])
    rows = {row["name"]: row for row in found["rows"]}
    assert rows["full: first episodes on new trays"]["value"] == pytest.approx((7.0 + 0.15) / 8)
    assert rows["full less no-reuse: first episodes on new trays"]["value"] == pytest.approx(2 / 8)
    assert rows["scratch: spills in first episodes on new trays"]["value"] == 1
    assert rows["full: false alarms on new trays"]["value"] == pytest.approx(1 / 37)
    good, spilled = found["goals"]
    assert (good["met"], spilled["met"], spilled["measured"]) == (False, True, 0.0)
    share = np.mean([(7.0 + 0.1 * i) / (7.2 + 0.1 * i) for i in range(4)])
    assert rows["full: first episodes on new trays, of the informed agent's"]["value"] == pytest.approx(share)


def test_intervals_are_of_rounds():
    # Five lives of a round that are all alike tell no more than one.
    firsts = [lives(1)[0]["full"].first[0] + 0.3 * i * i for i in range(4)]
    rounds = [[{agent: result(first) for agent in [*LIVING_AGENTS, INFORMED]}] * 5 for first in firsts]
    row = next(row for row in report(rounds)["rows"] if row["name"] == "full: first episodes on new trays")
    assert tuple(row["ci95"]) == mean_estimate(np.array(firsts) / 8).ci95
    assert row["n"] == 20


def test_the_curve_is_a_mean_over_ten_tasks():
    tasks, shares = curve(lives(2), "full")
    assert (tasks[0], tasks[-1]) == (10, 2 * N_TASKS)
    assert shares == pytest.approx((7.0 + 0.05) / 8)


def test_the_figure_is_drawn(tmp_path):
    tabletop_lives._draw(lives(), tmp_path)
    assert (tmp_path / "bench_tabletop_lives.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
@pytest.mark.sim
def test_a_short_round(monkeypatch, tmp_path):
    pytest.importorskip("mujoco", reason="needs the extra sim")
    agents = {name: LIVING_AGENTS[name] for name in ("full", "scratch", RAW)}
    monkeypatch.setattr(tabletop_lives, "LIVING_AGENTS", agents)
    store = CellStore(tmp_path, {"code": "as now"})
    (life,) = lived_round(5, n_tasks=2, lives=1, store=store)
    assert list(life) == ["full", "scratch", RAW, INFORMED]
    for found in life.values():
        assert len(found.first) == 4
        assert (found.first <= found.best + 1e-9).all()
    # A round that was stopped does not live a finished life again.
    monkeypatch.setattr(tabletop_lives, "_life", None)
    (again,) = lived_round(5, n_tasks=2, lives=1, store=store)
    for agent, found in life.items():
        np.testing.assert_allclose(found.first, again[agent].first, atol=1e-6)
        assert found.n_types == again[agent].n_types
