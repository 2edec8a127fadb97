"""A maze of C5.3: what its priors have met, and that a cell is plain data and the same each time."""

import json

import numpy as np
import pytest

from lifelore.core.mdp import TERMINAL
from reproduction.chapter5.c5_03_priors_in_search.run import (
    BETA,
    EVEN,
    FLAT,
    KINDS,
    PERCEPT,
    PLACE,
    PLAIN,
    PRUNED,
    cells,
    maze_of,
    run_cell,
)
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C5.3").sizes["quick"])

TINY = {
    **QUICK,
    "size": 9,
    "mazes": 2,
    "forms": ["proportion", "support"],
    "simulations": [10],
    "max_steps": 8,
    "pulls": 30,
}


@pytest.fixture(scope="module")
def found():
    return [run_cell(TINY, cell, 3) for cell in cells(TINY)]


def test_a_cell_is_plain_data_and_the_same_each_time(found):
    assert json.loads(json.dumps(found[1])) == found[1] == run_cell(TINY, {"maze": 1}, 3)
    assert found[0]["search"] != found[1]["search"]


def test_every_way_is_there_once(found):
    ways = [(s["kind"], s["form"], s["guides"], s["move"]) for s in found[0]["search"]]
    assert len(set(ways)) == len(ways) == 2 + 2 * 2 * 3
    orders = [(o["search"], o["kind"], o["form"]) for o in found[0]["depth_first"]]
    assert len(set(orders)) == len(orders) == (1 + 4) + (1 + 2) + 2
    starts = [(b["index"], b["kind"], b["form"], b["strength"]) for b in found[0]["bandit"]]
    assert len(set(starts)) == len(starts) == 3 * (2 + 2 * (1 + 3))


def test_an_unpruned_search_finds_the_goal(found):
    assert all(order["reached"] == 1 for order in found[0]["depth_first"] if order["search"] != PRUNED)


def test_no_prior_has_met_the_goal():
    maze = maze_of(TINY, (3, "C5.3", 0))
    goals = {int(s) for s in maze.tables.next_state[maze.tables.event & TERMINAL > 0]}
    assert len(goals) == 1
    goal = goals.pop()
    assert goal not in {maze.start, *maze.starts.tolist()}
    assert not maze.best[goal].any()
    # At its own goal a task counts nothing, so a goal met among 3 tasks would leave 2 counts or fewer there
    # and one not met has at least 3.
    probs = maze.probs_of[PLACE, "proportion"][goal]
    assert probs.min() <= 0.1 / (3 + 0.4)


def test_place_priors_read_states_and_percept_priors_percepts():
    maze = maze_of({**TINY, "size": 15}, (3, "C5.3", 1))
    distinct = {kind: len(np.unique(maze.probs_of[kind, "proportion"], axis=0)) for kind in KINDS}
    assert distinct[PERCEPT] < len(maze.best)
    for probs in maze.probs_of.values():
        assert probs.shape == maze.best.shape
        np.testing.assert_allclose(probs.sum(axis=1), 1)


def test_other_sizes_leave_the_first_mazes_as_they_are():
    one, other = (maze_of({**TINY, "training_tasks": n}, (3, "C5.3", 0)) for n in (1, 3))
    assert one.start == other.start
    np.testing.assert_array_equal(one.best, other.best)


def test_flat_and_even_starts_are_without_the_prior(found):
    flat = [b for b in found[0]["bandit"] if b["index"] == BETA and b["kind"] is None]
    assert [(b["form"], b["strength"]) for b in flat] == [(FLAT, 0.0), (EVEN, 4.0)]
    assert all(b["curve"][-1] == pytest.approx(b["regret"], abs=1e-4) for b in flat)
    assert {s["form"] for s in found[0]["search"] if s["kind"] is None} == {PLAIN}
