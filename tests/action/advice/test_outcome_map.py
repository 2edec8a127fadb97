"""Agents of other actions are watched and advised over common outcomes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.action.advice.outcome_map import OutcomeMap
from lifelore.core.errors import InputError


def test_by_hand():
    # The agent's actions: forward (outcome 1), two ways to turn about (outcome 0), a song (none).
    agent = OutcomeMap([1, 0, 0, -1], n_actions=3)
    assert [agent.common(7, a) for a in range(4)] == [1, 0, 0, -1]
    # Outcome 2, with half of the advice, is out of its reach: what is left, 1/4 and 1/4, becomes 1/2 and 1/2.
    assert agent.own_theta(0, [0.25, 0.25, 0.5]).tolist() == [0.5, 0.25, 0.25, 0]
    assert agent.own_theta(0, [0, 0, 1]).tolist() == [0, 0, 0, 0]


def test_state_by_state():
    turning = OutcomeMap([[0, 1], [1, 0]], n_actions=2)
    assert turning.common(0, 0) == turning.common(1, 1) == 0
    assert turning.own_theta(1, [0.9, 0.1]) == pytest.approx([0.1, 0.9])


@given(st.lists(st.integers(-1, 3), min_size=1, max_size=8), st.integers(0, 1000))
def test_mass_goes_to_the_outcomes_in_proportion(outcome, seed):
    theta = np.random.default_rng(seed).dirichlet(np.ones(4))
    own = OutcomeMap(outcome, 4).own_theta(0, theta)
    reachable = sorted({o for o in outcome if o >= 0})
    assert own.sum() == pytest.approx(1.0 if reachable else 0.0)
    for o in reachable:
        share = own[np.array(outcome) == o]
        assert share.sum() == pytest.approx(theta[o] / theta[reachable].sum())
        assert np.ptp(share) < 1e-12


def test_each_broken_rule_is_one_clear_line():
    with pytest.raises(InputError, match=r"outcome must hold actions in \[0, 2\) or -1, got 0..2"):
        OutcomeMap([0, 2], 2)
    with pytest.raises(InputError, match="outcome must have shape"):
        OutcomeMap([[[0]]], 2)
    with pytest.raises(InputError, match="action must be one of the agent's own"):
        OutcomeMap([0], 2).common(0, 1)
