"""Learners on the lattice: numbers by hand, and streams that are shared where they must be."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.planning.planning import best_actions, greedy_policy, optimal_q
from reproduction.chapter3.c3_02_lattice_prior.run import run_of
from reproduction.chapter3.learning.grid_tasks import (
    exact_prior,
    learn_task,
    mean_returns,
    rows_of,
    start_values,
    summary,
)
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine import curve_blocks, learning_run
from reproduction.engine.curve_blocks import block_edges, block_means
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.2").sizes["quick"])

SETTINGS = {**QUICK, "episodes": 40}


@pytest.fixture(scope="module")
def run():
    return run_of(SETTINGS, seed=3, number=0)


def test_schedule_by_hand():
    schedule = schedule_of({**SETTINGS, "episodes": 4}, [1.0, 0.5, 0.2])
    assert schedule.epsilon.tolist() == [1.0, 0.5, 0.25, 0.2]
    assert schedule.alpha.tolist() == [0.5] * 4


def test_goals_do_not_repeat_and_runs_differ(run):
    goals = [p.goal for p in run.testing]
    assert len(set(goals)) == SETTINGS["test_tasks"] == len(goals)
    assert len({p.goal for p in run.training}) == 5
    again, other = run_of(SETTINGS, 3, 0), run_of(SETTINGS, 3, 1)
    assert [p.goal for p in again.testing] == goals
    assert [p.goal for p in other.testing] != goals


def test_more_training_tasks_leave_the_first_ones_and_the_test_tasks_alone(run):
    more = run_of({**SETTINGS, "online_tasks": [0, 1, 5, 8]}, 3, 0)
    assert [p.goal for p in more.training][:5] == [p.goal for p in run.training]
    assert [p.goal for p in more.testing] == [p.goal for p in run.testing]


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
    returns, _ = learn_task(problem, None, schedule)
    np.testing.assert_allclose(returns, start_values(problem, SETTINGS["episodes"]), rtol=1e-12)


def test_no_action_of_the_prior_collides_and_goals_are_left_out(run):
    prior = exact_prior(run.training, 0.1)
    counts = prior.counts(np.arange(run.world.n_states))
    assert not counts[run.world.neighbour < 0].any()
    alone = exact_prior(run.training[:1], 0.1)
    assert not alone.counts([run.training[0].goal]).any()
    assert len(alone) == run.world.n_states - 1


def test_tied_actions_all_count(run):
    problem = run.training[0]
    best = best_actions(optimal_q(problem.tables, SETTINGS["discount"]))
    best[problem.goal] = False
    assert (best.sum(axis=1) > 1).any()  # a lattice has crossings from which two ways are equally short
    assert (exact_prior([problem], 0.1).counts(np.arange(len(best))) == best).all()


def test_plain_learning_is_learning_with_a_prior_that_has_seen_nothing(run):
    schedule = schedule_of(SETTINGS, [1.0, 0.98, 0.01])
    for ties in ("uniform", "prior"):
        plain, learner = learn_task(run.testing[1], None, schedule)
        rows = rows_of(run.testing[1], ActionPrior(4, 0.1), "proportion", ties)
        guided, other = learn_task(run.testing[1], rows, schedule)
        assert plain.tobytes() == guided.tobytes()
        assert learner.q.tobytes() == other.q.tobytes()
    taught = rows_of(run.testing[1], exact_prior(run.training, 0.1), "proportion", "uniform")
    assert learn_task(run.testing[1], taught, schedule)[0].tobytes() != plain.tobytes()


def test_a_draw_from_the_dirichlet_is_the_same_for_the_task_whenever_it_is_made(run):
    prior = exact_prior(run.training, 0.1)
    one, two = (rows_of(run.testing[0], prior, "dirichlet", "uniform").explore_cum for _ in range(2))
    other = rows_of(run.testing[1], prior, "dirichlet", "uniform").explore_cum
    assert (one == two).all()
    assert (one != other).any()


def test_learning_reaches_the_optimal_policy(run):
    schedule = schedule_of({**SETTINGS, "episodes": 3000}, [1.0, 1.0, 1.0])
    problem = run.testing[0]
    _, learner = learn_task(problem, None, schedule)
    policy = greedy_policy(learner.q)
    states = np.delete(np.arange(run.world.n_states), problem.goal)
    assert problem.best[states, policy[states]].all()


def test_mean_returns_is_the_mean_over_problems(run):
    schedule = schedule_of(SETTINGS, [0.1, 1.0, 0.1])
    curves = [learn_task(p, None, schedule)[0] for p in run.testing]
    np.testing.assert_allclose(mean_returns(run.testing, lambda p: None, schedule), sum(curves) / 3)


def test_summary_by_hand():
    settings = {"episodes": 20, "window": 2, "last": 4}
    best = np.full(20, 10.0)
    returns = np.array([-8.0] * 5 + [4.0, 6.0, 7.0] + [9.0] * 12)
    found = summary(settings, returns, best)
    assert found == {
        "first": -8.0,
        "first_ten": (5 * -8 + 4 + 6 + 7 + 9 + 9) / 10,
        "to_50": 7,  # the mean of the sixth and seventh return is 5
        "never_50": False,
        "to_80": 9,  # the mean of 7 and 9 is 8
        "never_80": False,
        "final": 0.9,
    }
    never = summary(settings, np.zeros(20), best)
    assert (never["to_80"], never["never_80"]) == (20, True)


def test_percent_of_optimal_is_of_the_best_from_the_same_starts():
    settings = {"episodes": 4, "window": 1, "last": 1}
    lucky = summary(settings, np.array([0.0, 9.0, 40.0, 90.0]), np.array([10.0, 90.0, 90.0, 100.0]))
    assert lucky["to_80"] == 4  # 9 of a possible 90 is not yet learning, whatever other starts would give


def test_blocks_by_hand(monkeypatch):
    monkeypatch.setattr(curve_blocks, "BLOCKS", 3)
    assert block_edges(100).tolist() == [0, 1, 10, 100]
    returns = np.concatenate([[5.0], np.full(9, 2.0), np.full(90, 1.0)])
    assert block_means(returns) == [5.0, 2.0, 1.0]


def test_blocks_hold_every_episode_once():
    for n in (1, 7, 120, 1000):
        edges = block_edges(n)
        assert (edges[0], edges[-1]) == (0, n)
        assert (np.diff(edges) > 0).all()
