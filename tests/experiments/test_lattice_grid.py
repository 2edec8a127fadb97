"""The cells of C3.2: the grid is whole and its cells do not disturb one another."""

import json

import numpy as np
import pytest

from lifelore.core.planning.planning import best_actions
from lifelore.experiments.chapter3.c3_02_lattice_prior.run import (
    PLAIN,
    cells,
    configurations,
    online_priors,
    run_cell,
)
from lifelore.experiments.chapter3.lattice_learning import learn_task, rows_of, run_of, schedule_of
from lifelore.experiments.engine.registry import claim_of

FULL = dict(claim_of("C3.2").sizes["full"])
QUICK = dict(claim_of("C3.2").sizes["quick"])

SMALL = {**QUICK, "episodes": 30, "runs": 1, "test_tasks": 2, "window": 5, "last": 5}


def test_the_grid_crosses_ties_form_and_pseudo_count_where_the_form_reads_it():
    found = configurations(FULL)
    assert len(found) == 2 * (2 * 3 + 2)
    assert {c["alpha0"] for c in found if c["form"] in ("support", "softmax")} == {None}
    assert {(c["form"], c["alpha0"]) for c in found if c["alpha0"]} == {
        (form, alpha0) for form in ("proportion", "dirichlet") for alpha0 in (0.01, 0.1, 1.0)
    }


def test_cells_are_runs_by_schedule_and_an_online_series_each():
    found = cells({**FULL, "runs": 2})
    assert [c["kind"] for c in found].count("grid") == 6
    assert [c["run"] for c in found if c["kind"] == "online"] == [0, 1]


@pytest.fixture(scope="module")
def grid():
    return run_cell(SMALL, {"kind": "grid", "schedule": [1.0, 0.98, 0.01], "run": 0}, 0)


def test_a_cell_is_plain_data_with_every_configuration(grid):
    assert json.loads(json.dumps(grid)) == grid
    named = [{key: m[key] for key in PLAIN} for m in grid["methods"]]
    assert named == [PLAIN, *configurations(SMALL)]


def test_curves_are_kept_for_the_headline_alone(grid):
    kept = {(m["ties"], m["alpha0"], m["form"]) for m in grid["methods"] if "curve" in m}
    assert kept == {(None, None, None), ("uniform", 0.1, "proportion"), ("prior", 0.1, "proportion")}


def test_leaving_out_configurations_moves_no_other(grid):
    fewer = {**SMALL, "forms": ["dirichlet"], "alpha0": [1.0]}
    alone = run_cell(fewer, {"kind": "grid", "schedule": [1.0, 0.98, 0.01], "run": 0}, 0)
    numbers = {json.dumps({k: m[k] for k in PLAIN}): m["first_ten"] for m in grid["methods"]}
    for m in alone["methods"]:
        assert m["first_ten"] == numbers[json.dumps({k: m[k] for k in PLAIN})]


def test_online_series_starts_from_nothing_and_counts_the_learners_own_policies():
    found = run_cell(SMALL, {"kind": "online", "run": 0}, 0)
    assert found["first_ten"]["learnt_0"] == found["first_ten"]["exact_0"] == found["plain"]
    assert found["same"] is True
    assert set(found["first_ten"]) == {f"{s}_{n}" for s in ("exact", "learnt") for n in (0, 1, 5)}


def test_online_prior_after_one_task_by_hand():
    run = run_of(SMALL, 0, 0)
    schedule = schedule_of(SMALL, [1.0, 0.98, 0.01])
    priors = online_priors(run, SMALL, schedule)
    assert [len(priors[0]), len(priors)] == [0, 6]
    rows = rows_of(run.training[0], priors[0], "proportion", "uniform")
    q = learn_task(run.training[0], rows, schedule)[1].q
    expected = np.where(q.max(axis=1, keepdims=True) > 0, best_actions(q), False)
    assert (priors[1].counts(np.arange(len(q))) == expected).all()
    assert not priors[1].counts([run.training[0].goal]).any()
