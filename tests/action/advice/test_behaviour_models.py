"""Models of behaviour: anything with probs(contexts)."""

import numpy as np
import pytest

from lifelore.action.advice.behaviour_models import Experts, Tabulated
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

CONTEXTS = np.array([[0, -1], [1, -1], [1, 0], [1, 1]])


def test_a_table_by_state_ignores_what_was_tried_last():
    assert Tabulated([[0, 1], [0.5, 0.5]]).probs(CONTEXTS).tolist() == [[0, 1]] + [[0.5, 0.5]] * 3


def test_a_table_with_three_axes_reads_what_was_tried_last():
    stubborn = np.array([[[0.5, 0.5], [1, 0], [0, 1]]] * 2)
    assert Tabulated(stubborn).probs(CONTEXTS).tolist() == [[0.5, 0.5], [0.5, 0.5], [1, 0], [0, 1]]


def test_experts_keep_mass_for_every_action_and_are_uniform_where_nothing_was_counted():
    prior = ActionPrior(2, alpha0=0.5)
    prior.update_trajectory([1], [0])
    assert Experts(prior).probs(CONTEXTS).tolist() == [[0.5, 0.5]] + [[0.75, 0.25]] * 3


@pytest.mark.parametrize("table", [[0.5, 0.5], [[0.5, 0.6]], [[-0.5, 1.5]], np.full((1, 2, 2), 0.5)])
def test_tables_that_are_none(table):
    with pytest.raises(InputError, match="table must"):
        Tabulated(table)
