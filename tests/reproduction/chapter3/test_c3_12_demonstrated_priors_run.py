"""Runs of C3.12: who shows which task, what is counted, and that comparisons are paired."""

from itertools import product

import numpy as np
import pytest

from reproduction.chapter3.c3_12_demonstrated_priors.run import (
    PEOPLE,
    SELF,
    SHOWN,
    WEIGHTS,
    WITHOUT_PRIOR,
    from_shown,
    grid_of,
    run_cell,
    run_of,
    self_trained,
)
from reproduction.chapter3.factory.modified_tasks import contexts_of
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.12").sizes["quick"])

SETTINGS = {**QUICK, "trajectories": [2, 4], "episodes": 6, "early": 2, "max_steps": 60}
HOW = {**{key: QUICK["default"][key] for key in ("features", "schedule", "ties")}, "alpha0": 0.1}


@pytest.fixture(scope="module")
def run():
    return run_of(SETTINGS, 0, 0)


def test_people_show_in_turn(run):
    assert [one.agent for one in run.shown["varied"]] == [f"person {i}" for i in range(4)]
    assert {one.agent for one in run.shown["familiar"]} == {"person 0"}
    assert [one.task for one in run.shown["expert"]] == ["0", "1", "2", "3"]


def test_an_expert_takes_best_steps_alone_and_weighs_one(run):
    for problem, one in zip(run.training, run.shown["expert"], strict=True):
        assert problem.best[one.states, one.actions].all()
    assert {weight for kind in WEIGHTS for weight in run.weights["expert", kind].values()} == {1.0}
    poor = run.weights["poor", "by steps"]["person 0"]
    assert 0.2 < poor < 0.8


def test_counts_of_what_was_shown_by_hand(run):
    how = {**HOW, "trajectories": 2}
    prior = from_shown(run, how, "expert", "equal")
    expected = {}
    for problem, one in list(zip(run.training, run.shown["expert"], strict=True))[:2]:
        codes = contexts_of(problem, "phi3")
        for state, action in zip(one.states, one.actions, strict=True):
            code = int(codes[state])
            expected.setdefault(code, np.zeros(6))[action] += 1
    for code, counts in expected.items():
        assert prior.counts([code])[0].tolist() == counts.tolist()
    assert len(prior) == len(expected)
    # The self-trained prior has counted the same states, and all others.
    own = self_trained(run, how)
    assert len(own) >= len(prior)
    assert (own.counts(prior.contexts) >= 1).any(axis=1).all()


def test_weights_scale_the_counts(run):
    how = {**HOW, "trajectories": 4}
    equal, weighed = (from_shown(run, how, "poor", weight) for weight in ("equal", "by steps"))
    weight = run.weights["poor", "by steps"]["person 0"]
    np.testing.assert_allclose(weighed.counts(equal.contexts), weight * equal.counts(equal.contexts), atol=1e-3)


def test_more_trajectories_leave_the_first_as_they_are(run):
    fewer = run_of({**SETTINGS, "trajectories": [2]}, 0, 0)
    for first, again in zip(fewer.shown["varied"], run.shown["varied"], strict=False):
        assert first is not None
        assert again is not None
        np.testing.assert_array_equal(first.actions, again.actions)
    assert [one.optimal for one in fewer.testing] == [one.optimal for one in run.testing]


def test_a_cell_holds_the_grid_and_everyone_at_the_default():
    cell = run_cell(SETTINGS, {"run": 0}, 0)
    methods = [numbers["method"] for numbers in cell["found"]]
    assert methods.count(WITHOUT_PRIOR) == 2
    assert methods.count(SELF) == methods.count(SHOWN) == len(grid_of(SETTINGS).cells)
    assert [(one["people"], one["weight"]) for one in cell["groups"]] == list(product(PEOPLE, WEIGHTS))
    assert [one["people"] for one in cell["people"]] == list(PEOPLE)
    assert cell == run_cell(SETTINGS, {"run": 0}, 0)
