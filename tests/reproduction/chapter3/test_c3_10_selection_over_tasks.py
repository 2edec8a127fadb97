"""Measures of C3.10 from made-up choices, by hand, what of a policy counts, and a few small tasks."""

from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.core.planning.planning import best_actions
from reproduction.chapter3.c3_10_selection_over_tasks.measure import (
    GOAL,
    measure,
    rows,
    settled_after,
    shares,
)
from reproduction.chapter3.c3_10_selection_over_tasks.run import SERIES, mask_of, run_cell
from reproduction.chapter3.factory.modified_tasks import CARDINALS, FULL_SET, learn_problem, problem_of
from reproduction.chapter3.factory.online_selection import Counting, OnlineAgent, counted
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.10")
QUICK = dict(claim_of("C3.10").sizes["quick"])

SETTINGS = {**QUICK, "runs": 4, "tasks": 4, "last": 2}
ALL = (1 << 10) - 1
WITH_ITEMS = GOAL | 1 << 9


def made_up(**of_series):
    """Four runs, all of which choose φ2 from the third task on; `of_series`: the masks (4, 4) of some."""
    usual = [[ALL, WITH_ITEMS, GOAL, GOAL]] * 4
    chosen = [{name: of_series.get(name, usual)[run] for name in SERIES} for run in range(4)]
    return [{"run": run, "chosen": chosen[run]} for run in range(4)]


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_masks_by_hand():
    # PosUM, PosML, PosMR and PosDM are the columns 1, 3, 5 and 7.
    assert GOAL == mask_of(CARDINALS) == 2 + 8 + 32 + 128
    assert mask_of(FULL_SET.names) == 1023
    found = shares(np.array([[3, 0], [1, 512]]))
    assert found[:, 0].tolist() == [1.0, 0.5] + [0.0] * 8
    assert found[:, 1].tolist() == [0.0] * 9 + [0.5]


def test_when_a_run_has_settled_by_hand():
    masks = np.array([[ALL, GOAL, GOAL, GOAL], [GOAL] * 4, [GOAL, ALL, GOAL, GOAL], [GOAL, GOAL, GOAL, ALL]])
    assert settled_after(masks) == [2, 1, 3, 5]


def test_shares_at_the_end_by_hand():
    three_of_four = [[GOAL] * 4] * 3 + [[GOAL, GOAL, GOAL, WITH_ITEMS ^ 2]]
    found = measure(SETTINGS, made_up(learnt=three_of_four))
    assert found["exact_least_share_of_four"].value == 1.0
    assert found["exact_largest_share_of_others"].value == 0.0
    assert found["exact_settled_share"].value == 1.0
    assert found["exact_settled_after"].value == 3.0
    assert found["learnt_least_share_of_four"].value == 0.75
    assert found["learnt_largest_share_of_others"].value == 0.25
    assert found["learnt_settled_share"].value == 0.75
    assert found["learnt_settled_after"].value == pytest.approx((1 + 1 + 1 + 5) / 4)
    assert found["learnt_settled_share"].n == 4
    # Even four of four runs are not more than 80 % for certain; of thirty, all but one series settles.
    assert found["grid_settled"].value == 0.0
    many = made_up(exact=[[ALL] * 4] * 4) * 8
    assert measure(SETTINGS, many)["grid_settled"].value == pytest.approx(6 / 7)


def test_verdicts():
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up()))) == "holds"
    items = [[WITH_ITEMS] * 4] * 4
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(learnt=items)))) == "holds in part"
    late = [[ALL, ALL, ALL, GOAL]] * 4
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(exact=late)))) == "holds in part"
    three = [[GOAL ^ 2] * 4] * 4
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(exact=three, learnt=three)))) == "does not hold"


def test_every_condition_asks_of_something_measured():
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(measure(SETTINGS, made_up()))


@pytest.fixture(scope="module")
def problem():
    return problem_of({"discount": 0.99, "components": 1}, (6, "C3.10"))


def test_what_of_a_learnt_policy_counts_by_hand(problem):
    q = np.zeros_like(problem.best, float)
    visits = np.zeros_like(problem.best, int)
    q[0], visits[0] = [-5, -3, -3, 0, 0, 0], [1, 2, 3, 0, 0, 0]  # all tried moves cost: promises nothing
    q[1], visits[1] = [1, 7, 0, 0, 0, 0], [1, 1, 0, 0, 0, 0]
    last = len(q) - 1  # a completed state
    q[last], visits[last] = [9, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0]
    learner = SimpleNamespace(q=q, visits=visits)
    tried, promising, every = (
        counted(problem, learner, Counting("learnt", over))  # type: ignore[arg-type]
        for over in ("tried", "visited", "all")
    )
    assert tried[0].tolist() == [False, True, True, False, False, False]
    assert tried[1].tolist() == promising[1].tolist() == [False, True, False, False, False, False]
    assert tried.sum() == 3
    assert promising.sum() == 1
    assert every[0].tolist() == [False, False, False, True, True, True]  # never tried, worth 0
    assert every[2].all()
    assert not every[problem.task.completed].any()


def test_tried_actions_agree_with_a_loop_over_states(problem):
    settings = {**QUICK, "max_steps": 400}
    _, learner = learn_problem(problem, None, schedule_of(settings, settings["schedule"]))
    found = counted(problem, learner, Counting("learnt", "tried"))
    for state in np.flatnonzero(learner.visits.any(axis=1)):
        tried = np.flatnonzero(learner.visits[state])
        best = tried[best_actions(learner.q[[state]][:, tried])[0]]
        assert np.flatnonzero(found[state]).tolist() == best.tolist()
    assert found.any(axis=1).sum() == learner.visits.any(axis=1).sum()


def test_exact_policies_count_everywhere_or_on_the_way(problem):
    assert counted(problem, None, Counting("exact", "all")) is problem.best
    on_the_way = counted(problem, None, Counting("exact", "way"))
    assert np.flatnonzero(on_the_way.any(axis=1)).tolist() == sorted(set(problem.way.tolist()))
    assert (on_the_way[problem.way] == problem.best[problem.way]).all()


def test_before_its_first_task_an_agent_explores_uniformly(problem):
    schedule = schedule_of(QUICK, QUICK["schedule"])
    plain_rewards = learn_problem(problem, None, schedule)[0].rewards
    for selects in (True, False):
        agent = OnlineAgent(selects, Counting("exact", "all"), 0.1, "uniform")
        assert agent.chosen == FULL_SET.names
        assert agent.learn(problem, schedule).rewards.tolist() == plain_rewards.tolist()
        assert agent.learn(problem, schedule).rewards.tolist() != plain_rewards.tolist()


def test_a_small_run_agrees_with_an_agent_of_its_own():
    settings = {**QUICK, "tasks": 2}
    result = run_cell(settings, {"run": 0}, 7)
    assert {len(masks) for masks in result["chosen"].values()} == {2}
    agent = OnlineAgent(True, Counting("exact", "way"), 0.1, "uniform")
    for i, mask in enumerate(result["chosen"]["exact, on the way"]):
        agent.count(problem_of(settings, (7, "C3.10", 0, i)), None)
        assert mask_of(agent.chosen) == mask


def test_the_figure_is_drawn_from_rows_alone():
    results = made_up()
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, results)), "rows": rows(SETTINGS, results)}
    panels = [axes for axes in CLAIM.draw(result).axes if axes.images]
    assert len(panels) == len(SERIES)
    # Rows of the picture: N, W, E, S, then the others, Items last.
    shown = np.asarray(panels[0].images[0].get_array())
    assert shown[[0, 3, 4, 9]].tolist() == [[1] * 4, [1] * 4, [1, 0, 0, 0], [1, 1, 0, 0]]
