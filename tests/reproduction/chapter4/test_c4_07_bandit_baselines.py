"""C4.7: comparisons from made-up sums by hand, and a tiny run."""

import json

import pytest

from reproduction.chapter4.c4_07_bandit_baselines.measure import best_gp, measure, rows
from reproduction.chapter4.c4_07_bandit_baselines.run import (
    CASES_SHOWN,
    DOUBTING,
    REUSE,
    run_cell,
)
from reproduction.chapter4.surveillance.peers import PEERS
from reproduction.chapter4.surveillance.runs import DEFAULT_WORLD
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.7")
QUICK = dict(claim_of("C4.7").sizes["quick"])

SMALL = {**QUICK, "tasks": 2, "groups": 3, "episodes": 12}


def made_up(first: float = 10.0):
    """Sums of 100 for expected improvement, 200 for GP-UCB with the true metric, 400 for others, plus the task."""
    found = []
    doubting = {"uncertain, with unseen": DOUBTING}
    for case, names in (dict.fromkeys(CASES_SHOWN, (*REUSE, *PEERS)) | doubting).items():
        for name in names:
            base = {"EI": 100.0, "GP-UCB, true metric": 200.0, "UCB1": 500.0}.get(name, 400.0)
            curve = [first, 1.0, 1.0] if name == "EI" else [5.0, 5.0, 5.0]
            found.append(
                {
                    "method": name, "case": case, **DEFAULT_WORLD, "groups": 3, "tuned": {},
                    "sums": [base + task for task in range(6)], "seen": [1, 0] * 3,
                    "ended": [3] * 6, "late": [0.0] * 6,
                    "curve": {"mean": curve, "error": [0.1] * 3},
                }
            )  # fmt: skip
    return found


def test_comparisons_by_hand():
    results = made_up()
    assert best_gp(results, "exact") == "GP-UCB, true metric"
    found = measure(SMALL, results)
    assert found["best_GP_UCB_minus_EI_exact"].value == pytest.approx(100)
    assert found["UCB1_minus_GP_UCB_headline"].value == pytest.approx(100)
    assert found["interval_estimation_minus_UCB1_exact"].value == pytest.approx(-100)
    assert found["EI_over_best_GP_UCB_exact"].value == pytest.approx(102.5 / 202.5)
    assert found["EI_over_eps_greedy_on_means_exact"].value == pytest.approx(102.5 / 402.5)
    assert found["interval_estimation_minus_EI_learnt"].value == pytest.approx(300)
    # The default reserve with exact models, and two cases of learnt ones; noise is none, so no interval is either.
    assert (found["grid_sentence"].value, found["grid_sentence"].n) == (0.0, 3)
    # In the first episode it has more, from the second on less.
    assert found["first_episode_below_for_good_exact"].value == 2
    assert measure(SMALL, made_up(first=1.0))["first_episode_below_for_good_exact"].value == 1
    # Every second task was never in training: 1, 3 and 5 more.
    assert found["EI_doubting_over_best_GP_UCB_unseen"].value == pytest.approx(103 / 203)
    assert found["IDS_doubting_over_best_GP_UCB_unseen"].value == pytest.approx(403 / 203)
    assert found["cumulative_first_4_tasks_EI_exact"].value == pytest.approx(101.5)


def test_the_grid_asks_for_the_whole_sentence():
    results = made_up()
    for result in results:  # 1 % more a task, so that differences vary and have intervals
        result["sums"] = [result["sums"][0] * (1 + 0.01 * task) for task in range(6)]
    assert measure(SMALL, results)["grid_sentence"].value == 1.0
    # In one of three cases GP-UCB has more regret than UCB1, in another interval estimation less than reuse.
    for method, case, sum_ in (("GP-UCB", "learnt", 600.0), ("interval estimation", "headline", 50.0)):
        for result in results:
            if (result["method"], result["case"]) == (method, case):
                result["sums"] = [sum_ * (1 + 0.01 * task) for task in range(6)]
    assert measure(SMALL, results)["grid_sentence"].value == pytest.approx(1 / 3)


def test_a_tiny_run():
    cells = [run_cell(SMALL, cell, 1) for cell in CLAIM.cells(SMALL) if "GP-UCB," not in cell["method"]]
    missing = [c for c in CLAIM.cells(SMALL) if "GP-UCB," in c["method"]]
    plain = {c["case"]: c for c in cells if c["method"] == "GP-UCB"}
    cells = json.loads(json.dumps(cells + [{**plain[cell["case"]], **cell} for cell in missing]))
    found = measure(SMALL, cells)
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(found)
    kept = json.loads(json.dumps(rows(SMALL, cells)))
    assert all(row["given"] for row in kept)
    figure = CLAIM.draw({"settings": SMALL, "rows": kept})
    assert len(figure.axes) == 3
