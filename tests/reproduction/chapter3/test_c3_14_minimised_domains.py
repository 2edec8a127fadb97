"""Claim C3.14: what minimised domains keep, by hand in corridors and the errata's counterexamples; measures."""

import numpy as np
import pytest

from lifelore.action.search.domain_reduction import minimised_domain, tables_within
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from lifelore.core.planning.planning import best_actions, optimal_q
from reproduction.chapter3.c3_14_minimised_domains.minimised_worlds import Solved, TaskSet, task_set, with_goal
from reproduction.chapter3.c3_14_minimised_domains.run import (
    domain_of,
    exact,
    kept,
    measure,
    readings,
    traps,
    values_within,
)
from reproduction.engine.registry import claim_of

SETTINGS = {**claim_of("C3.14").sizes["quick"], "size": 7, "tasks": 3, "random_states": 12, "max_steps": 40}
DISCOUNT = 0.9


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


def test_a_corridor_by_hand():
    tasks = ends_of_a_corridor()
    domain = domain_of(tasks)
    # Each task's policy is kept where only the other comes: nothing is lost but the walls.
    everything = [[0, 1], [1, 0], [1, 1], [2, 0], [2, 1], [3, 0], [3, 1], [4, 0]]
    assert np.argwhere(domain.pairs).tolist() == everything
    assert traps(tasks.tasks[0], domain) == [0, 0]
    # By pairs of one and the same task, a step to the other end cannot be taken back (errata E36).
    repaired = minimised_domain([t.tables for t in tasks.tasks], [t.best for t in tasks.tasks], "repaired")
    assert traps(tasks.tasks[0], repaired) == [0, 2]


def test_what_is_kept_in_a_corridor_by_hand():
    tasks = ends_of_a_corridor()
    repaired = minimised_domain([t.tables for t in tasks.tasks], [t.best for t in tasks.tasks], "repaired")
    q = values_within(tasks.tasks[0].tables, repaired, DISCOUNT)
    assert q[2, 0] == pytest.approx(90)
    assert q[1].tolist() == [pytest.approx(100), -np.inf]
    # Straying to the right ends at the other goal, stuck: the wall's 10 for ever, two steps off.
    assert q[2, 1] == pytest.approx(-10 / 0.1 * 0.9**2)
    for domain in (repaired, domain_of(tasks)):
        assert kept(tasks.tasks[0], domain, DISCOUNT)
    only_right = minimised_domain([tasks.tasks[1].tables], [tasks.tasks[1].best])
    assert not kept(tasks.tasks[0], only_right, DISCOUNT)


def errata_e8(outcomes=(1.0,), odd: int | None = None) -> TaskSet:
    """Task 1: 0 -a-> 1; from 2, where it never comes, 2 -b-> 3 -a-> 1. Task 2: goal 4 by 0 -b-> 2 -a-> 4."""
    follow = np.array([(1, 2), (1, 1), (4, 3), (1, 1), (4, 4)], np.int32)[:, :, None].repeat(len(outcomes), axis=2)
    if odd is not None:
        follow[2, 1, 1] = odd
    cum = np.cumsum(outcomes)
    event = np.zeros(follow.shape, np.uint8)
    base = Tables(follow, np.zeros(follow.shape), event, cum, np.zeros(1, np.int32))
    return TaskSet("by hand", [solved(with_goal(base, goal, [0]), goal) for goal in (1, 4)], DISCOUNT, 20)


def test_the_printed_domain_is_undefined_where_a_policy_never_comes():
    found = exact(errata_e8())
    assert found["defined"] is False
    assert exact(ends_of_a_corridor())["defined"] is True


def test_renormalised_outcomes_change_the_printed_values():
    # 2 -b-> leads to 3 (3/4) or 4 (1/4); without 3 it leads to 4 for certain, which pays task 2 as well as a does.
    tasks = errata_e8((0.75, 0.25), odd=4)
    domain = domain_of(tasks)
    assert np.argwhere(domain.leading_out).tolist() == [[2, 1]]
    second = tasks.tasks[1]
    assert second.q[2].tolist() == [pytest.approx(100), pytest.approx(25)]
    assert values_within(second.tables, domain, DISCOUNT)[2].tolist() == [pytest.approx(100)] * 2


def test_values_where_nothing_leads_out_are_those_of_the_exact_planner():
    for i in range(10):
        tasks = task_set("slippery, few starts", SETTINGS, (i, "twin"))
        domain = minimised_domain([t.tables for t in tasks.tasks], [t.best for t in tasks.tasks], "repaired")
        stuck = ~domain.pairs.any(axis=1)
        for task in tasks.tasks:
            within = tables_within(task.tables, domain.pairs, "stay")
            lowest = min(0.0, float(task.tables.reward.min())) / (1 - tasks.discount)
            within.reward[stuck], within.event[stuck] = lowest, TERMINAL
            q = optimal_q(within, tasks.discount)
            q[~domain.pairs] = -np.inf
            np.testing.assert_allclose(values_within(task.tables, domain, tasks.discount), q, atol=1e-6)


def test_numbers_by_hand():
    settings = {**SETTINGS, "kinds": ["lattice, every start", "random, few starts"]}

    def cell(kind, run, traps, collisions):
        found = {"kept": [True, run > 0], "traps": traps, "defined": run == 0}
        costs = {"collisions": collisions, "to_80": [[100, 50 + run], [100, 150]]}
        return {"kind": kind, "run": run, "exact": [found], **costs}

    results = [
        cell(kind, run, traps, collisions)
        for run in range(3)
        for kind, traps, collisions in (
            ("lattice, every start", [[0, 0], [0, 1]], [0.4, 0.0]),
            ("random, few starts", [[4, 1], [0, 0]], [0.2, 0.1 + 0.01 * run]),
        )
    ]
    found = measure(settings, results)
    assert found["theorem"].value == pytest.approx(10 / 12)
    assert found["defined"].value == pytest.approx(1 / 3)
    assert found["trap_difference"].value == -3
    assert found["new_traps"].value == pytest.approx(3 / 9)
    assert found["collisions_ratio"].value == pytest.approx(0.33 / 0.6)
    assert found["to_80_ratio"].value == pytest.approx(0.51)
    each = {(cell["kind"], str(cell["schedule"])): numbers for cell, numbers in readings(settings, results)}
    assert "trap_difference" not in each["lattice, every start", "printed"]
    assert each["lattice, every start", "printed"]["new_traps"].value == 0.5
    assert set(each["random, few starts", "[0.1, 1.0, 0.1]"]) == {"to_80_ratio"}
    assert each["random, few starts", "[0.1, 1.0, 0.1]"]["to_80_ratio"].value == pytest.approx(1.5)
