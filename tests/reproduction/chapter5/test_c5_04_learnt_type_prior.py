"""C5.4: popularity by hand, measures by hand, and learners that have learnt nothing yet."""

import numpy as np
import pytest

from lifelore.core.streams import stream
from reproduction.chapter5.c5_04_learnt_type_prior.run import (
    AGENTS,
    CONTEXT,
    DRIFT,
    LIBRARY,
    WORLDS,
    measure,
    popularity,
    run_cell,
)
from reproduction.engine.registry import claim_of

SMALL = {
    **claim_of("C5.4").sizes["quick"],
    "lives": 3,
    "tasks": 6,
    "steady_for": 2,
    "episodes": 3,
    "early": 2,
    "contexts": 2,
}


def test_popularity_by_hand():
    steady, own, drift = (popularity(SMALL, world, 4, stream(1, "test")) for world in WORLDS)
    assert steady.shape == own.shape == drift.shape == (6, 2, 4)
    assert sorted(steady[0, 0]) == pytest.approx(sorted(np.array([1, 1 / 2, 1 / 3, 1 / 4]) * 12 / 25))
    assert sorted(own[0, 1]) == pytest.approx(sorted(np.array([1, 1 / 4, 1 / 9, 1 / 16]) * 144 / 205))
    assert (steady == steady[0, 0]).all()
    assert (own == own[0]).all()
    assert (drift[0] == drift[1]).all()
    assert (drift[1] != drift[2]).any()


def test_measures_by_hand():
    regret = {"library": 8.0, "learnt": 6.0, "context": 4.0, "no decay": 5.0, "true": 2.0}
    results = [
        {"world": world, "agent": agent, "early": [[99.0] * 3 + [regret[agent]] * 3] * 3}
        for world in WORLDS
        for agent in AGENTS
    ]
    found = measure(SMALL, results)
    assert found["learnt_over_library_steady"].value == pytest.approx(6 / 8)
    assert found["context_over_learnt_contexts"].value == pytest.approx(4 / 6)
    assert found["decay_over_none_drift"].value == pytest.approx(4 / 5)


def test_before_any_task_is_learnt_a_learner_knows_the_librarys_prior_alone():
    first, second = (
        np.array(run_cell(SMALL, {"world": DRIFT, "agent": agent}, 1)["early"]) for agent in (CONTEXT, LIBRARY)
    )
    assert first.shape == (3, 6)
    assert (first[:, 0] == second[:, 0]).all()
