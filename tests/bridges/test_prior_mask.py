"""Masks from a prior, by hand in a lake of ice that does not slip."""

import gymnasium
import numpy as np
import pytest
from gymnasium.spaces import Discrete

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.observations import check_actions
from lifelore.bridges.prior_mask import PriorMask
from lifelore.core.errors import InputError

LEFT, DOWN, RIGHT, UP = range(4)


def lake():
    return gymnasium.make("FrozenLake-v1", is_slippery=False)


def places(observations):
    return np.asarray(observations)


def one_action_a_place():
    """Of place p, action p mod 4 alone is counted."""
    prior = ActionPrior(4)
    prior.update(np.arange(16), np.eye(4, dtype=bool)[np.arange(16) % 4])
    return prior


def test_masks_by_hand():
    prior = ActionPrior(4)
    prior.update([0] * 5, np.eye(4, dtype=bool)[[DOWN, DOWN, DOWN, RIGHT, UP]])
    env = PriorMask(lake(), prior, places, threshold=0.3, escape=0.0)
    env.reset(seed=0)
    assert env.action_masks().tolist() == [False, True, False, False]
    env.step(DOWN)  # place 4 was never counted
    assert env.action_masks().tolist() == [True] * 4
    low = PriorMask(lake(), prior, places, escape=0.0)
    low.reset(seed=0)
    assert low.action_masks().tolist() == [False, True, True, True]


def test_a_mask_stays_until_the_next_step_and_follows_it():
    env = PriorMask(lake(), one_action_a_place(), places, escape=0.5)
    place, _ = env.reset(seed=1)
    escapes = []
    for number in range(2000):
        now = env.action_masks()
        assert env.action_masks().tolist() == now.tolist()
        own = np.arange(4) == place % 4
        assert now.all() or now.tolist() == own.tolist()
        escapes.append(bool(now.all()))
        place, _, terminated, truncated, _ = env.step(number % 4)
        if terminated or truncated:
            place, _ = env.reset()
    assert np.mean(escapes) == pytest.approx(0.5, abs=0.045)  # four deviations


def test_a_seed_fixes_the_escapes():
    def escapes(seed):
        env = PriorMask(lake(), one_action_a_place(), places, escape=0.5)
        env.reset(seed=seed)
        return tuple(bool(env.step(LEFT) and env.action_masks().all()) for _ in range(15))

    assert escapes(4) == escapes(4)
    assert len({escapes(seed) for seed in range(4)}) == 4


def test_new_counts_are_heeded_from_the_next_episode_on():
    prior = ActionPrior(4)
    env = PriorMask(lake(), prior, places, escape=0.0)
    env.reset(seed=0)
    prior.update([0], [[False, True, False, False]])
    env.step(LEFT)
    assert env.action_masks().all()
    env.reset()
    assert env.action_masks().tolist() == [False, True, False, False]


def test_what_is_refused():
    with pytest.raises(
        InputError, match=r"prior must be for the environment's actions Discrete\(4\), got one for 3"
    ):
        PriorMask(lake(), ActionPrior(3), places)
    for escape in (-0.1, 1.1, float("nan")):
        with pytest.raises(InputError, match="escape must lie in"):
            PriorMask(lake(), ActionPrior(4), places, escape=escape)
    with pytest.raises(InputError, match="numbered from 0"):
        check_actions(ActionPrior(4), Discrete(4, start=1))
