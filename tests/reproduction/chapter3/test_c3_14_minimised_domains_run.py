"""What minimised domains keep, by hand in corridors and the errata's counterexamples; learners within them."""

import numpy as np
import pytest

from lifelore.action.search.domain_reduction import minimised_domain
from lifelore.core.learning.q_learning import Schedule
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from lifelore.core.planning.planning import best_actions, optimal_q
from reproduction.chapter3.c3_14_minimised_domains.minimised_worlds import (
    KINDS,
    Solved,
    TaskSet,
    random_tables,
    task_set,
    with_goal,
)
from reproduction.chapter3.c3_14_minimised_domains.run import (
    WHOLE,
    WITHIN,
    best_returns,
    domains_of,
    exact,
    kept,
    learn_within,
    run_cell,
    traps,
    values_within,
)
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.14").sizes["quick"])

DISCOUNT = 0.9
SETTINGS = {**QUICK, "size": 7, "tasks": 3, "learnt_tasks": 1, "random_states": 12, "worlds": 1, "episodes": 12}
SETTINGS |= {"max_steps": 40, "explored": 3, "window": 5}


def corridor(goal: int, n: int = 5, start: int = 2) -> Solved:
    """States in a row, left and right; the ends are walls that refuse and cost 10; the goal pays 100."""
    here = np.arange(n)
    follow = np.column_stack([np.maximum(here - 1, 0), np.minimum(here + 1, n - 1)]).astype(np.int32)
    event = np.where(follow == here[:, None], COLLISION, 0).astype(np.uint8)
    reward = np.where(event > 0, -10.0, 0.0)
    base = Tables(follow[:, :, None], reward[:, :, None], event[:, :, None], np.ones(1), np.zeros(1, np.int32))
    return solved(with_goal(base, goal, [start]), goal)


def solved(tables: Tables, goal: int) -> Solved:
    q = optimal_q(tables, DISCOUNT)
    best = best_actions(q)
    best[goal] = False
    return Solved(tables, q, best, (0, "test", goal))


def ends_of_a_corridor() -> TaskSet:
    return TaskSet("by hand", [corridor(0), corridor(4)], DISCOUNT, 20)


def test_the_three_definitions_in_a_corridor_by_hand():
    domains = domains_of(ends_of_a_corridor())
    assert np.argwhere(domains["repaired"].pairs).tolist() == [[1, 0], [2, 0], [2, 1], [3, 1]]
    # Each task's policy is kept where only the other comes: nothing is lost but the walls.
    everything = [[0, 1], [1, 0], [1, 1], [2, 0], [2, 1], [3, 0], [3, 1], [4, 0]]
    assert np.argwhere(domains["printed"].pairs).tolist() == everything
    assert np.argwhere(domains["closed"].pairs).tolist() == everything


def test_traps_in_a_corridor_by_hand():
    tasks = ends_of_a_corridor()
    domains = domains_of(tasks)
    assert traps(tasks.tasks[0], domains["repaired"]) == {
        "traps": 0, "traps_left": 0, "traps_within": 2, "states": 5
    }  # fmt: skip
    assert traps(tasks.tasks[0], domains["printed"])["traps_within"] == 0
    assert traps(tasks.tasks[0], domains["closed"])["traps_within"] == 0


def test_what_is_kept_in_a_corridor_by_hand():
    tasks = ends_of_a_corridor()
    q = values_within(tasks.tasks[0].tables, domains_of(tasks)["repaired"], DISCOUNT)
    assert q[2, 0] == pytest.approx(90)
    assert q[1].tolist() == [pytest.approx(100), -np.inf]
    # Straying to the right ends at the other goal, stuck: the wall's 10 for ever, two steps off.
    assert q[2, 1] == pytest.approx(-10 / 0.1 * 0.9**2)
    for domain in domains_of(tasks).values():
        assert kept(tasks.tasks[0], domain, DISCOUNT) == {"return_kept": True, "policy_kept": True}
    only_right = minimised_domain([tasks.tasks[1].tables], [tasks.tasks[1].best])
    assert kept(tasks.tasks[0], only_right, DISCOUNT) == {"return_kept": False, "policy_kept": False}


def errata_e8(outcomes=(1.0,), odd: int | None = None) -> TaskSet:
    """Task 1: 0 -a-> 1; from 2, where it never comes, 2 -b-> 3 -a-> 1. Task 2: goal 4 by 0 -b-> 2 -a-> 4."""
    follow = np.array([(1, 2), (1, 1), (4, 3), (1, 1), (4, 4)], np.int32)[:, :, None].repeat(len(outcomes), axis=2)
    if odd is not None:
        follow[2, 1, 1] = odd
    cum = np.cumsum(outcomes)
    event = np.zeros(follow.shape, np.uint8)
    base = Tables(follow, np.zeros(follow.shape), event, cum, np.zeros(1, np.int32))
    return TaskSet("by hand", [solved(with_goal(base, goal, [0]), goal) for goal in (1, 4)], DISCOUNT, 20)


def test_the_printed_domain_undefined_and_closed_by_hand():
    found = exact(errata_e8())
    assert [found[form]["undefined"] for form in ("printed", "repaired", "closed")] == [1, 0, 0]
    closed = domains_of(errata_e8())["closed"]
    assert closed.states.all()  # what task 1 would do in 2 leads to 3, which the other forms leave out
    assert not closed.leading_out.any()
    # Task 1 is trapped in 2 and 4 where the repaired form leaves it no way; 1 is its goal, 4 leads nowhere in D.
    assert [t["traps_within"] for t in found["repaired"]["tasks"]] == [2, 1]
    assert found["closed"]["tasks"][0]["traps_within"] == found["closed"]["tasks"][0]["traps"] == 1


def test_renormalised_outcomes_change_the_printed_values():
    # 2 -b-> leads to 3 (3/4) or 4 (1/4); without 3 it leads to 4 for certain, which pays task 2 as well as a does.
    tasks = errata_e8((0.75, 0.25), odd=4)
    domains = domains_of(tasks)
    assert np.argwhere(domains["printed"].leading_out).tolist() == [[2, 1]]
    second = tasks.tasks[1]
    assert second.q[2].tolist() == [pytest.approx(100), pytest.approx(25)]
    assert values_within(second.tables, domains["printed"], DISCOUNT)[2].tolist() == [pytest.approx(100)] * 2


def test_two_ways_to_the_same_values():
    """The kernel's values where nothing leads out are those of the plain sweeps."""
    from reproduction.chapter3.c3_14_minimised_domains.run import _renormalised_values

    for i in range(10):
        tasks = task_set("slippery, few starts", SETTINGS, (i, "twin"))
        domain = domains_of(tasks)["repaired"]
        for task in tasks.tasks:
            one = values_within(task.tables, domain, tasks.discount)
            other = _renormalised_values(task.tables, domain, tasks.discount)
            np.testing.assert_allclose(one, other, atol=1e-6)


@pytest.mark.parametrize("kind", ["lattice, one start", "random, few starts", "slippery, few starts"])
def test_repaired_and_closed_keep_everything_and_closed_adds_no_traps(kind):
    for i in range(5):
        found = exact(task_set(kind, SETTINGS, (i, "sets")))
        for form in ("repaired", "closed"):
            assert all(t["return_kept"] and t["policy_kept"] for t in found[form]["tasks"])
            assert found[form]["undefined"] == 0
        assert all(t["traps_within"] <= t["traps"] for t in found["closed"]["tasks"])


def test_learners_within_take_kept_actions_alone():
    task = corridor(0)
    pairs = np.zeros((5, 2), bool)
    pairs[1:, 0] = True  # left, and nothing in the goal
    once = Schedule(np.ones(4), np.full(4, 0.5), 10, DISCOUNT)
    curve = learn_within(task, pairs, "stay", once, "test")
    assert curve.steps.tolist() == [2, 2, 2, 2]
    assert curve.reached.all()
    assert curve.collisions.sum() == 0
    greedy = Schedule(np.zeros(4), np.full(4, 0.5), 10, DISCOUNT)
    assert learn_within(task, pairs, "stay", greedy, "test").steps.tolist() == [2, 2, 2, 2]
    # Right only: stuck at the other end, for nothing if it stays there, at a wall if it is free.
    pairs = np.zeros((5, 2), bool)
    pairs[:4, 1] = True
    assert learn_within(task, pairs, "stay", once, "test").rewards.tolist() == [0.0] * 4
    assert learn_within(task, pairs, "free", once, "test").rewards.sum() < 0


def test_best_returns_are_of_the_starts_drawn():
    task = corridor(0, start=2)
    assert best_returns(task, 3, "test").tolist() == [pytest.approx(90)] * 3
    anywhere = task._replace(tables=task.tables._replace(starts=np.arange(1, 5, dtype=np.int32)))
    drawn = best_returns(anywhere, 200, "test")
    assert set(np.round(drawn, 6)) == {100.0, 90.0, 81.0, 72.9}


def test_a_cell_holds_every_domain_under_every_schedule():
    cell = run_cell(SETTINGS, {"kind": "random, few starts", "run": 0}, 0)
    found = [(n["form"], n["dead_ends"], n["schedule"][0]) for n in cell["learning"]]
    assert found == [(f, e, s) for f, e in ((WHOLE, ""), *WITHIN) for s in (0.1, 1.0)]
    assert len(cell["exact"]) == 2
    assert len(run_cell(SETTINGS, {"kind": KINDS[0], "run": 0}, 0)["exact"]) == 1


def test_random_tables_have_walls_and_sinks():
    tables = random_tables(200, 4, np.random.default_rng(0), (0.8, 0.2))
    refused = tables.event[:, :, 0] == COLLISION
    assert 0.2 < refused.mean() < 0.3
    here = np.arange(200)[:, None, None]
    assert (tables.next_state[refused] == np.broadcast_to(here, tables.next_state.shape)[refused]).all()
    assert 0.08 < (tables.next_state == here).all(axis=(1, 2)).mean() < 0.25
    goal = with_goal(tables, 7, [0])
    entered = (tables.next_state == 7) & (np.arange(200) != 7)[:, None, None]
    assert ((goal.event & TERMINAL > 0) == entered).all()
