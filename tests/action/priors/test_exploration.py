"""What a prior tells a learner: rows of the Q-learner, and the costs of trying for a planned search."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import SENSIBLE, TRY_COST, prior_rows, try_costs
from lifelore.core import InputError, NotFoundError, Tables
from lifelore.core.learning.q_learning import uniform_rows

TABLES = Tables.from_matrices(np.tile(np.eye(16)[:, None], (1, 4, 1)), np.zeros(16), terminal=[])
"""16 states, four actions; all actions stay."""


@pytest.mark.parametrize("ties", ["uniform", "prior"])
def test_a_uniform_prior_gives_the_rows_of_plain_q_learning(ties):
    guided, plain = prior_rows(TABLES, np.arange(16), ActionPrior(4).probs, ties), uniform_rows(TABLES)
    for ours, rows in ((guided.explore_cum, plain.explore_cum), (guided.tie_weight, plain.tie_weight)):
        assert ours[guided.context_row[:, 0]] / ours[0, -1] == pytest.approx(rows[plain.context_row[:, 0]])


def test_rows_are_read_by_context():
    prior = ActionPrior(4, alpha0=0.5)
    prior.update([7], [[True, False, False, False]], weight=2.0)
    contexts = np.where(np.arange(16) % 2, 7, -3)
    rows = prior_rows(TABLES, contexts, prior.probs, ties="prior")
    assert rows.context_row.ravel().tolist() == [0, 1] * 8  # codes in ascending order: -3, 7
    assert rows.explore_cum[0] == pytest.approx([0.25, 0.5, 0.75, 1.0])
    assert np.diff(rows.explore_cum[1], prepend=0) == pytest.approx([2.5 / 4, 0.125, 0.125, 0.125])
    assert rows.tie_weight[1] == pytest.approx([2.5 / 4, 0.125, 0.125, 0.125])
    assert (prior_rows(TABLES, contexts, prior.probs).tie_weight == 1).all()


def test_forms_with_zeros_keep_a_trace_among_ties():
    prior = ActionPrior(4)
    prior.update([0], [[True, False, False, False]])
    rows = prior_rows(TABLES, np.zeros(16, int), lambda c: prior.probs(c, "support", escape=0.0), "prior")
    assert rows.explore_cum.tolist() == [[1.0] * 4]
    assert rows.tie_weight.tolist() == [[1.0, 1e-12, 1e-12, 1e-12]]


def test_rows_that_break_a_rule():
    with pytest.raises(NotFoundError, match="ties must be one of uniform, prior, got 'first'"):
        prior_rows(TABLES, np.arange(16), ActionPrior(4).probs, ties="first")
    with pytest.raises(InputError, match="4 columns"):
        prior_rows(TABLES, np.arange(16), ActionPrior(3).probs)
    with pytest.raises(InputError, match="each of 16 states"):
        prior_rows(TABLES, np.arange(5), ActionPrior(4).probs)


def test_costs_by_hand():
    # Within e² of the best: nothing. A nat beyond: TRY_COST steps.
    probs = np.exp([[0.0, -SENSIBLE, -SENSIBLE - 1, -SENSIBLE - 2.5]])
    assert try_costs(probs)[0] == pytest.approx([0, 0, TRY_COST, 2.5 * TRY_COST])
