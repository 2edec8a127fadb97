"""A maze of C5.3: what its priors have met, that a cell is plain data; and its measures by hand."""

import numpy as np
import pytest

from lifelore.core.mdp import TERMINAL
from reproduction.chapter5.c5_03_priors_in_search.run import (
    BANDITS,
    EVEN,
    FORMS,
    GUIDES,
    KINDS,
    NONE,
    ORDERS,
    PERCEPT,
    PLACE,
    maze_of,
    measure,
    readings,
)
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C5.3").sizes["quick"])
TINY = {**QUICK, "size": 9, "simulations": 10, "max_steps": 8, "pulls": 30}


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


def test_measures_by_hand():
    """Without a prior half of six mazes are solved, 10 nodes and more expanded, 20 and more lost."""
    priors = [{"kind": kind, "form": form} for kind in KINDS for form in FORMS]
    results = [
        {
            "search": [{**NONE, "guides": None, "reached": maze % 2 == 0}]
            + [{**prior, "guides": guides, "reached": maze < 5} for prior in priors for guides in GUIDES],
            "depth_first": [{**NONE, "order": None, "expanded": 10.0 + maze}]
            + [{**prior, "order": order, "expanded": 8.0 + maze / 2} for prior in priors for order in ORDERS],
            "bandit": [
                {"index": index, **prior, "regret": lost + maze}
                for index in BANDITS
                for prior, lost in [(NONE, 20.0), (EVEN, 15.0), *((prior, 10.0) for prior in priors)]
            ],
        }
        for maze in range(6)
    ]
    measured = measure({}, results)
    assert measured["search_gain"].value == pytest.approx(2 / 6)
    # 8 + maze/2 and 10 + maze have the means 9.25 and 12.5.
    assert measured["nodes_ratio"].value == pytest.approx(9.25 / 12.5)
    assert measured["ucb1_ratio"].value == pytest.approx(12.5 / 22.5)
    assert measured["beta_even_ratio"].value == pytest.approx(12.5 / 17.5)
    assert len(list(readings({}, results))) == len(priors) * (len(GUIDES) + len(ORDERS) + 1)
