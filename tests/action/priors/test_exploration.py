"""What a prior tells a learner: rows of the Q-learner, and the costs of trying for a planned search."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import SENSIBLE, TRY_COST, prior_rows, try_costs
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.q_learning import Schedule, learn, new_learner, uniform_rows
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from lifelore.core.streams import stream

SIDE = 4
GOAL = SIDE * SIDE - 1


def room() -> Tables:
    """An empty square room of 16 cells, four moves, the goal in the last corner."""
    n = SIDE * SIDE
    next_state, reward = np.empty((n, 4, 1), np.int32), np.zeros((n, 4, 1))
    event = np.zeros((n, 4, 1), np.uint8)
    for s in range(n):
        for a, (d_row, d_column) in enumerate(((-1, 0), (1, 0), (0, 1), (0, -1))):
            row, column = s // SIDE + d_row, s % SIDE + d_column
            inside = 0 <= row < SIDE and 0 <= column < SIDE
            next_state[s, a] = row * SIDE + column if inside else s
            if not inside:
                reward[s, a], event[s, a] = -10, COLLISION
            elif row * SIDE + column == GOAL:
                reward[s, a], event[s, a] = 100, TERMINAL
    return Tables(next_state, reward, event, np.ones(1), np.arange(n - 1, dtype=np.int32))


def learnt(tables, rows, episodes=200, epsilon=0.1, alpha=0.5):
    who = new_learner(tables.n_states, 4, stream(0, "world"), stream(0, "own"))
    curve = new_curve(episodes)
    plan = Schedule(np.full(episodes, epsilon), np.full(episodes, alpha), 200, 0.95)
    learn(tables, rows, plan, who, curve, 10**9)
    return who, curve


@pytest.mark.parametrize("ties", ["uniform", "prior"])
def test_with_a_uniform_prior_it_is_q_learning_bit_for_bit(ties):
    tables = room()
    states = np.arange(tables.n_states)
    guided = learnt(tables, prior_rows(tables, states, ActionPrior(4).probs, ties))
    plain = learnt(tables, uniform_rows(tables))
    for a, b in zip((*guided[0], *guided[1]), (*plain[0], *plain[1]), strict=True):
        assert np.array_equal(a, b)


def test_rows_are_read_by_context():
    tables = room()
    prior = ActionPrior(4, alpha0=0.5)
    prior.update([7], [[True, False, False, False]], weight=2.0)
    contexts = np.where(np.arange(16) % 2, 7, -3)
    rows = prior_rows(tables, contexts, prior.probs, ties="prior")
    assert rows.context_row.ravel().tolist() == [0, 1] * 8  # codes in ascending order: -3, 7
    assert rows.explore_cum[0] == pytest.approx([0.25, 0.5, 0.75, 1.0])
    assert np.diff(rows.explore_cum[1], prepend=0) == pytest.approx([2.5 / 4, 0.125, 0.125, 0.125])
    assert rows.tie_weight[1] == pytest.approx([2.5 / 4, 0.125, 0.125, 0.125])
    assert (prior_rows(tables, contexts, prior.probs).tie_weight == 1).all()


def test_forms_with_zeros_keep_a_trace_among_ties():
    tables = room()
    prior = ActionPrior(4)
    prior.update([0], [[True, False, False, False]])
    rows = prior_rows(tables, np.zeros(16, int), lambda c: prior.probs(c, "support", escape=0.0), "prior")
    assert rows.explore_cum.tolist() == [[1.0] * 4]
    assert rows.tie_weight.tolist() == [[1.0, 1e-12, 1e-12, 1e-12]]


def test_rows_that_break_a_rule():
    tables = room()
    with pytest.raises(NotFoundError, match="ties must be one of uniform, prior, got 'first'"):
        prior_rows(tables, np.arange(16), ActionPrior(4).probs, ties="first")
    with pytest.raises(InputError, match="4 columns"):
        prior_rows(tables, np.arange(16), ActionPrior(3).probs)
    with pytest.raises(InputError, match="each of 16 states"):
        prior_rows(tables, np.arange(5), ActionPrior(4).probs)


def test_costs_by_hand():
    # Within e² of the best: nothing. A nat beyond: TRY_COST steps.
    probs = np.exp([[0.0, -SENSIBLE, -SENSIBLE - 1, -SENSIBLE - 2.5]])
    assert try_costs(probs)[0] == pytest.approx([0, 0, TRY_COST, 2.5 * TRY_COST])
