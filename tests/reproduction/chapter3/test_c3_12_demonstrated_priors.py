"""Who shows which task, and what of a demonstration counts."""

import numpy as np
import pytest

from reproduction.chapter3.c3_12_demonstrated_priors.run import PEOPLE, demonstrate, from_shown
from reproduction.chapter3.factory.learning import contexts_of, exact_prior
from reproduction.chapter3.factory.modified_tasks import problems_of

HOW = {"features": "phi3", "alpha0": 0.1}


@pytest.fixture(scope="module")
def training():
    return problems_of({"discount": 0.99, "components": 1}, (0, "C3.12", "training"), 4)


@pytest.fixture(scope="module")
def shown(training):
    return {people: [demonstrate(problem, people, i) for i, problem in enumerate(training)] for people in PEOPLE}


def test_an_expert_takes_best_steps_alone(training, shown):
    for problem, one in zip(training, shown["expert"], strict=True):
        assert problem.best[one.states, one.actions].all()


def test_counts_of_what_was_shown_by_hand(training, shown):
    prior = from_shown(training[:2], shown["expert"], HOW)
    expected = {}
    for problem, one in zip(training[:2], shown["expert"][:2], strict=True):
        codes = contexts_of(problem, "phi3")
        for state, action in zip(one.states, one.actions, strict=True):
            expected.setdefault(int(codes[state]), np.zeros(6))[action] += 1
    for code, counts in expected.items():
        assert prior.counts([code])[0].tolist() == counts.tolist()
    assert len(prior) == len(expected)
    # The self-trained prior has counted the same states, and all others.
    own = exact_prior(training[:2], HOW["features"], HOW["alpha0"])
    assert len(own) >= len(prior)
    assert (own.counts(prior.contexts) >= 1).any(axis=1).all()
