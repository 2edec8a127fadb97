"""The invariances that a prior of C3.4 holds."""

import pytest

from lifelore.action.priors.action_prior import ActionPrior
from reproduction.chapter3.c3_04_factory_priors.run import ADVICE, grid_of, least_invariance
from reproduction.chapter3.factory.learning import N_ACTIONS, exact_prior, hand_made_prior, problem_of, solved
from reproduction.engine.registry import claim_of

SETTINGS = claim_of("C3.4").settings("quick")


def test_a_prior_from_policies_holds_all_invariances_and_incorrect_advice_does_not():
    problem = problem_of(SETTINGS, (2, 5), (1, "invariances"))
    default = grid_of(SETTINGS).default
    learnt = exact_prior([solved((2, 5), 0.99), solved((1, 7), 0.99)], default["encoding"], 0.1)
    assert least_invariance(problem, learnt, default) > 0
    assert least_invariance(problem, ActionPrior(N_ACTIONS, 0.1), default) == pytest.approx(0)
    # Codes by the list's order tell states of the task apart, as advice does.
    wrong = hand_made_prior(ADVICE["incorrect"](problem.task), 35, 0.1)
    assert least_invariance(problem, wrong, default) < 0
