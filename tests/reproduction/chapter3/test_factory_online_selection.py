"""What of a policy counts, by hand, and the features that agents choose (C3.9, C3.10)."""

from types import SimpleNamespace

import numpy as np
import pytest

from reproduction.chapter3.c3_09_online_features.run import mask_of, run_cell
from reproduction.chapter3.c3_10_selection_over_tasks.run import GOAL, numbers
from reproduction.chapter3.factory.modified_tasks import problem_of
from reproduction.chapter3.factory.online_selection import OnlineAgent, counted
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.registry import claim_of

QUICK = claim_of("C3.10").settings("quick")
SETTINGS = {**QUICK, "source": ["learnt", "exact"], "schedule": ["printed"]}
ALL = (1 << 10) - 1
WITH_ITEMS = GOAL | 1 << 9


@pytest.fixture(scope="module")
def problem():
    return problem_of({"discount": 0.99, "components": 1}, (6, "C3.10"))


def test_what_of_a_learnt_policy_counts_by_hand(problem):
    q = np.zeros_like(problem.best, float)
    visits = np.zeros_like(problem.best, int)
    q[0], visits[0] = [-5, -3, -3, 0, 0, 0], [1, 2, 3, 0, 0, 0]  # all tried moves cost
    q[1], visits[1] = [1, 7, 0, 0, 0, 0], [1, 1, 0, 0, 0, 0]
    last = len(q) - 1  # a completed state
    q[last], visits[last] = [9, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0]
    learner = SimpleNamespace(q=q, visits=visits)
    tried, every = (
        counted(problem, learner, source)  # type: ignore[arg-type]
        for source in ("learnt", "learnt, all states")
    )
    assert tried[0].tolist() == [False, True, True, False, False, False]
    assert tried[1].tolist() == [False, True, False, False, False, False]
    assert tried.sum() == 3
    assert every[0].tolist() == [False, False, False, True, True, True]  # never tried, worth 0
    assert every[2].all()
    assert not every[problem.task.completed].any()


def test_shares_of_runs_by_hand():
    found = numbers(np.array([[ALL, GOAL, GOAL]] * 3 + [[GOAL, GOAL, WITH_ITEMS ^ 2]]), last=2)
    assert {name: of.value for name, of in found.items()} == {
        "settled_share": 0.75, "rarest_of_four": 0.75, "commonest_other": 0.25,
    }  # fmt: skip
    # One run of four: more than half of all is not certain, even of four of four.
    assert found["settled_share"].ci95[0] < 0.5


@pytest.fixture(scope="module")
def results():
    return [run_cell(SETTINGS, {"run": run}, 8) for run in range(2)]


def test_a_small_run_agrees_with_an_agent_of_its_own(results):
    schedule = schedule_of({**SETTINGS, "max_steps": 2000}, "printed")
    agent = OnlineAgent(True, "learnt", 0.1, "uniform")
    ours = next(found for found in results[0]["found"] if found["method"] == "selected")
    for i in range(2):
        problem = problem_of(SETTINGS, (8, "C3.9", 0, i))
        rewards = agent.learn(problem, schedule).rewards
        assert [ours["first"][i], ours["last"][i]] == [rewards[0], rewards[-1]]
        assert ours["chosen"][i] == mask_of(agent.chosen)
        assert results[0]["optimal"][i] == problem.optimal
    # Nobody has a prior in the first task.
    at_default = {f["method"]: f["first"][0] for f in reversed(results[0]["found"]) if f["max_steps"] == 2000}
    assert len(set(at_default.values())) == 1
