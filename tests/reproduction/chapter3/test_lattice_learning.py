"""Learners on the lattice: numbers by hand, and streams that are shared where they must be."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.planning.planning import optimal_q
from reproduction.chapter3.c3_02_lattice_prior.run import run_of
from reproduction.chapter3.learning import grid_tasks
from reproduction.chapter3.learning.grid_tasks import (
    PLAIN,
    STATE,
    Trained,
    choices_of,
    compared,
    exact_prior,
    learnt_by_choice,
    returns_of,
    rows_of,
    start_values,
    summary,
)
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine import learning_run
from reproduction.engine.learning_run import learnt
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.2").sizes["quick"])

SETTINGS = {**QUICK, "episodes": 40}


@pytest.fixture(scope="module")
def run():
    return run_of(SETTINGS, seed=3, number=0)


def test_start_values_are_what_an_optimal_learner_earns(run, monkeypatch):
    # A learner that begins with the exact values, never explores and never learns must earn exactly the best
    # return from each start: so `start_values` follows the very starts that learners meet.
    problem = run.testing[0]
    q = optimal_q(problem.tables, SETTINGS["discount"])
    make = learning_run.new_learner

    def knowing(*arguments):
        learner = make(*arguments)
        learner.q[:] = q
        return learner

    monkeypatch.setattr(learning_run, "new_learner", knowing)
    schedule = schedule_of({**SETTINGS, "learning_rate": 0.0}, [0.0, 1.0, 0.0])
    curve, _ = learnt(problem.tables, problem.stream, None, schedule)
    np.testing.assert_allclose(curve.returns, start_values(problem, SETTINGS["episodes"]), rtol=1e-12)


def test_plain_learning_is_learning_with_a_prior_that_has_seen_nothing(run):
    problem, schedule = run.testing[1], schedule_of(SETTINGS, [1.0, 0.98, 0.01])
    of = problem.tables, problem.stream
    for ties in ("uniform", "prior"):
        plain, learner = learnt(*of, None, schedule)
        rows = rows_of(problem, ActionPrior(4, 0.1), "proportion", ties)
        guided, other = learnt(*of, rows, schedule)
        assert plain.returns.tobytes() == guided.returns.tobytes()
        assert learner.q.tobytes() == other.q.tobytes()
    taught = rows_of(problem, exact_prior(run.training, 0.1), "proportion", "uniform")
    assert learnt(*of, taught, schedule)[0].returns.tobytes() != plain.returns.tobytes()


def test_every_combination_of_the_choices_and_the_default_first():
    settings = {"schedule": ["printed", [0.1, 1.0, 0.1]], "ties": ["uniform"], "form": ["proportion"]}
    found = choices_of({**settings, "alpha0": [0.1, 1.0]})
    assert [(c["schedule"], c["alpha0"]) for c in found] == [
        ("printed", 0.1), ("printed", 1.0), ([0.1, 1.0, 0.1], 0.1), ([0.1, 1.0, 0.1], 1.0),
    ]  # fmt: skip


def test_a_number_is_what_learning_alone_gives(run):
    small = {**SETTINGS, "schedule": [[0.1, 1.0, 0.1]], "form": ["proportion", "dirichlet"], "alpha0": [0.1]}
    trained = {"prior": Trained(STATE, run.training)}
    found = learnt_by_choice(small, run.testing, trained, 0)
    schedule, place = schedule_of(small, [0.1, 1.0, 0.1]), 3
    assert choices_of(small)[place] == {
        "schedule": [0.1, 1.0, 0.1], "ties": "prior", "form": "dirichlet", "alpha0": 0.1
    }  # fmt: skip
    prior = exact_prior(run.training, 0.1)
    returns = returns_of(run.testing, lambda p: rows_of(p, prior, "dirichlet", "prior"), schedule)
    plain = returns_of(run.testing, lambda p: None, schedule)
    assert found["choices"][place]["prior"]["mean"] == pytest.approx(np.mean(returns))
    assert found["choices"][place][PLAIN]["first"] == pytest.approx(np.mean([r[0] for r in plain]))
    assert set(found["curves"]) == {PLAIN, "prior"}
    later = learnt_by_choice(small, run.testing, trained, small["reading_runs"])
    assert len(later["choices"]) == 1
    assert later["choices"][0] == found["choices"][0]
    assert not later["curves"]


def test_comparison_by_hand():
    def run(ours, theirs):
        keys = ("first", "mean", "to_50", "to_80")
        return {"a": dict(zip(keys, ours, strict=True)), "b": dict(zip(keys, theirs, strict=True))}

    one, two = run((2, 30, 40, 90), (-60, 20, 80, 100)), run((4, 34, 60, 110), (-50, 20, 80, 100))
    results = [{"choices": [one, two]}, {"choices": [two]}]  # a later run has the default alone
    found = compared(results, 0, "a", "b")
    assert {name: number.value for name, number in found.items()} == pytest.approx(
        {"first_gain": 58, "mean_gain": 12, "to_50_ratio": 50 / 80, "to_80_ratio": 1.0}
    )
    assert compared(results, 1, "a", "b")["first_gain"].n == 1


def test_summary_by_hand(monkeypatch):
    monkeypatch.setattr(grid_tasks, "WINDOW", 2)
    best = np.full(20, 10.0)
    returns = np.array([-8.0] * 5 + [4.0, 6.0, 7.0] + [9.0] * 12)
    found = summary(returns, best)
    assert found == {
        "first": -8.0,
        "first_ten": (5 * -8 + 4 + 6 + 7 + 9 + 9) / 10,
        "mean": (5 * -8 + 4 + 6 + 7 + 12 * 9) / 20,
        "to_50": 7,  # the mean of the sixth and seventh return is 5
        "to_80": 9,  # the mean of 7 and 9 is 8
    }
    assert summary(np.zeros(20), best)["to_80"] == 20
