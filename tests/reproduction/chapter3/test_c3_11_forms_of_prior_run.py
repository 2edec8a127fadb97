"""One prior in several forms: forms by hand, pooled counts by a slow tally, streams shared where they must be."""

import json

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.mdp import TERMINAL
from reproduction.chapter3.c3_11_forms_of_prior.run import (
    FORMS,
    KEYS,
    WITHOUT_PRIOR,
    grid_of,
    probs_of,
    rows_of,
    run_cell,
    run_of,
    summary,
)
from reproduction.chapter3.factory.modified_tasks import contexts_of, learn_problem, problem_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.registry import claim_of

FULL = dict(claim_of("C3.11").sizes["full"])
QUICK = dict(claim_of("C3.11").sizes["quick"])

SMALL = {**QUICK, "episodes": 6, "early": 2, "max_steps": [50, 100], "features": ["phi2", "phi3"]}
SMALL["default"] = {**QUICK["default"], "max_steps": 100}


@pytest.fixture(scope="module")
def run():
    return run_of(SMALL, 3, 0)


def test_forms_of_four_counts_by_hand():
    # Of eight policies, in one observation: 6 went north, 2 south, none elsewhere; α⁰ = 1/2.
    prior = ActionPrior(6, 0.5)
    prior.update([7] * 6, np.tile(np.eye(6, dtype=bool)[0], (6, 1)))
    prior.update([7] * 2, np.tile(np.eye(6, dtype=bool)[1], (2, 1)))
    random = np.random.default_rng(0)

    def form(name):
        return probs_of(prior, np.array([7]), name, 8, random)[0]

    share = np.array([6.5, 2.5, 0.5, 0.5, 0.5, 0.5]) / 11
    np.testing.assert_allclose(form("proportion"), share)
    raw = np.exp([6.0, 2, 0, 0, 0, 0])
    np.testing.assert_allclose(form("softmax of counts"), raw / raw.sum())
    a_policy = np.exp([6 / 8, 2 / 8, 0, 0, 0, 0])
    np.testing.assert_allclose(form("softmax of counts a policy"), a_policy / a_policy.sum())
    for name, scale in (("softmax of proportions", 1), ("softmax of 10 × proportions", 10)):
        np.testing.assert_allclose(form(name), np.exp(scale * share) / np.exp(scale * share).sum())
    draws = np.array([form("dirichlet") for _ in range(4000)])
    # The deviation of a share of mean 6.5 / 11 is sqrt(p (1 - p) / 12) = 0.142, of the mean of 4000 0.0022.
    assert draws[:, 0].mean() == pytest.approx(share[0], abs=0.01)
    assert draws[:, 0].std() == pytest.approx(0.142, abs=0.01)


@pytest.mark.parametrize("form", FORMS)
def test_forms_are_probabilities_and_uniform_where_nothing_is_known(form):
    prior = ActionPrior(6, 0.1)
    prior.update([1], [[True, False, True, False, False, False]])
    probs = probs_of(prior, np.array([1, 2]), form, 1, np.random.default_rng(1))
    np.testing.assert_allclose(probs.sum(axis=1), 1)
    if form != "dirichlet":
        np.testing.assert_allclose(probs[1], 1 / 6)


def test_pooled_counts_by_a_slow_tally(run):
    tally = {}
    for i in range(3):
        problem = problem_of(SMALL, (3, "C3.11", 0, "training", i))
        task, best, codes = problem.task, problem.best, contexts_of(problem, "phi3")
        for state in range(
            task.domain.n_states - task.factory.n_cells
        ):  # the last configuration is the finished one
            row = tally.setdefault(int(codes[state]), np.zeros(6))
            row += best[state]
        assert not best[task.completed].any()
        assert best[~task.completed].any(axis=1).all()
    prior = run.priors["phi3", 3]
    assert prior.contexts.tolist() == sorted(tally)
    np.testing.assert_array_equal(prior.counts(sorted(tally)), [tally[code] for code in sorted(tally)])


def test_the_prior_of_fewer_policies_is_that_of_the_first(run):
    first = run_of({**SMALL, "policies": [1]}, 3, 0).priors["phi2", 1]
    assert first.contexts.tolist() == run.priors["phi2", 1].contexts.tolist()
    assert (first.counts(first.contexts) == run.priors["phi2", 1].counts(first.contexts)).all()


def test_the_optimal_reward_is_that_of_the_exact_policy(run):
    for problem in run.testing:
        tables, q = problem.tables, problem.task.optimal_q()
        state, total, event = int(tables.starts[0]), 0.0, 0
        while not event & TERMINAL:
            action = int(q[state].argmax())
            total += tables.reward[state, action, 0]
            state, event = int(tables.next_state[state, action, 0]), int(tables.event[state, action, 0])
        assert problem.optimal == total


def test_summary_by_hand():
    # Two tasks, four episodes; deviations (n - 1) of two numbers are their distance over the root of 2.
    rewards = np.array([[-8.0, -4.0, 0.0, 2.0], [-4.0, -4.0, 4.0, 6.0]])
    found = summary(rewards, 2)
    half = 2**-0.5
    assert found == pytest.approx({"early": -5.0, "all": -1.0, "spread_early": 2 * half})
    # Opposite ups and downs spread every episode, and not the means of the tasks.
    assert summary(np.array([[0.0, 2.0], [2.0, 0.0]]), 2)["spread_early"] == pytest.approx(2 * half)


def test_a_draw_from_the_dirichlet_is_the_same_for_the_task_whenever_it_is_made(run):
    prior, how = run.priors["phi3", 3], SMALL["default"]
    one, two = (rows_of(run.testing[0], prior, "dirichlet", how).explore_cum for _ in range(2))
    assert (one == two).all()
    mean = rows_of(run.testing[0], prior, "proportion", how).explore_cum
    assert (one != mean).any()


def test_a_prior_that_has_seen_nothing_is_uniform_exploration(run):
    schedule = schedule_of({**SMALL, "max_steps": 100}, [1.0, 0.95, 0.01])
    problem = run.testing[0]

    def rewards(rows):
        return learn_problem(problem, rows, schedule)[0].rewards.tobytes()

    how = {**SMALL["default"], "ties": "prior"}
    for form in ("proportion", "softmax of counts", "softmax of counts a policy"):
        assert rewards(rows_of(problem, ActionPrior(6), form, how)) == rewards(None)


def test_the_grid_of_full_by_counting():
    found = grid_of(FULL).cells
    # 3 sets of features × 2 schedules × 2 ties, then one other α⁰, cap and number of policies.
    assert len(found) == 12 + 3
    assert len({json.dumps(how) for how in found}) == 15
    assert [how["alpha0"] for how in found].count(1.0) == [how["policies"] for how in found].count(10) == 1
    assert {key: FULL["default"][key] for key in KEYS} in found


@pytest.fixture(scope="module")
def cell():
    return run_cell(SMALL, {"run": 0}, 3)


def test_a_cell_is_plain_data_with_every_form_in_every_cell_of_the_grid(run, cell):
    assert json.loads(json.dumps(cell)) == cell
    forms = [found["form"] for found in cell["found"]]
    # Uniform exploration knows neither features nor ties: 2 schedules, and the other cap.
    expected = {WITHOUT_PRIOR: 3, **dict.fromkeys(FORMS, len(grid_of(SMALL).cells))}
    assert {form: forms.count(form) for form in expected} == expected
    assert sum("mean" in found for found in cell["found"]) == 2 * (1 + len(FORMS))
    assert cell["optimal"] == pytest.approx(np.mean([problem.optimal for problem in run.testing]))


def test_a_number_is_what_learning_alone_gives(run, cell):
    how = {**SMALL["default"], "features": "phi2", "ties": "prior", "schedule": [0.1, 1.0, 0.1]}
    found = next(
        f for f in cell["found"] if f["form"] == "softmax of counts" and all(f[key] == how[key] for key in KEYS)
    )
    schedule = schedule_of({**SMALL, "max_steps": 100}, how["schedule"])
    prior = run.priors["phi2", 3]
    rewards = [
        learn_problem(problem, rows_of(problem, prior, "softmax of counts", how), schedule)[0].rewards
        for problem in run.testing
    ]
    assert found["all"] == pytest.approx(np.mean(rewards))
    early = np.std([r[: SMALL["early"]] for r in rewards], axis=0, ddof=1)
    assert found["spread_early"] == pytest.approx(early.mean())


def test_leaving_out_choices_moves_no_number(cell):
    fewer = {**SMALL, "features": ["phi3"], "ties": ["uniform"], "policies": [3]}
    numbers = {json.dumps([f["form"], *(f[key] for key in KEYS)]): f["all"] for f in cell["found"]}
    for found in run_cell(fewer, {"run": 0}, 3)["found"]:
        assert found["all"] == numbers[json.dumps([found["form"], *(found[key] for key in KEYS)])]
