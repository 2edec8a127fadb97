"""Claim C3.2: the prior made online and the numbers of a result by hand."""

import numpy as np
import pytest

from lifelore.core.planning.planning import best_actions
from reproduction.chapter3.c3_02_lattice_prior.run import measure, online_prior, readings, run_of
from reproduction.chapter3.learning.grid_tasks import PLAIN, choices_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.learning_run import learnt
from reproduction.engine.registry import claim_of

SETTINGS = {**claim_of("C3.2").sizes["quick"], "episodes": 30, "testing_tasks": 2}


def test_online_prior_after_one_task_by_hand():
    run, choice = run_of({**SETTINGS, "training_tasks": 1}, 0, 0), choices_of(SETTINGS)[0]
    schedule = schedule_of(SETTINGS, [1.0, 0.98, 0.01])
    prior = online_prior(run, choice, schedule)
    q = learnt(run.training[0].tables, run.training[0].stream, None, schedule)[
        1
    ].q  # before the first task there is no prior
    expected = np.where(q.max(axis=1, keepdims=True) > 0, best_actions(q), False)
    assert (prior.counts(np.arange(len(q))) == expected).all()
    assert not prior.counts([run.training[0].goal]).any()


def test_numbers_by_hand():
    def learner(first, to_80):
        return {"first": first, "first_ten": first + 10, "mean": 30.0, "to_50": 20, "to_80": to_80}

    results = [
        {
            "online": 11.0 + run,
            "optimal": 60.0,
            "choices": [{PLAIN: learner(-50.0, 100), "eps_qsap": learner(2.0 + run, 90 + run)}],
        }
        for run in range(3)
    ]
    choice, numbers = next(readings(SETTINGS, results))
    assert choice == choices_of(SETTINGS)[0]
    found = {**numbers, **measure(SETTINGS, results)}
    assert found["first"].value == 3.0
    assert found["to_80_ratio"].value == pytest.approx(0.91)
    # The online prior's first ten returns are 1 below the exact one's; from no prior to the optimum it is 100.
    assert found["online_minus_exact"].value == pytest.approx(-0.01)
