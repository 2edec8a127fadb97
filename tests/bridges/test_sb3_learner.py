"""DQN as the learner of a long-lived agent: it learns, goes on from a policy, and memory gives the policy back."""

import gymnasium
import numpy as np
import pytest
from gymnasium.spaces import Box, Dict, Discrete

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent import BatchContexts, LongLivedAgent
from lifelore.core.errors import InputError

pytest.importorskip("stable_baselines3")

from lifelore.bridges.sb3_learner import DQNLearner

pytestmark = pytest.mark.deep

FAST = {"learning_starts": 100, "target_update_interval": 100, "learning_rate": 1e-2, "gamma": 0.9, "seed": 0}
TRAINED = {**FAST, "exploration_fraction": 0.5, "train_freq": 1}


class Corridor(gymnasium.Env):
    """Seven places in a row, from the middle; an end pays 1, the other 0. The hidden type says which."""

    observation_space = Box(0.0, 6.0, (1,), np.float32)
    action_space = Discrete(2)

    def __init__(self, pays):
        self.pays = pays

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place, self.steps = 3, 0
        return self.seen(), {}

    def step(self, action):
        self.place, self.steps = self.place + (1 if action else -1), self.steps + 1
        ended = self.place in (0, 6)
        return self.seen(), float(ended and self.place == self.pays), ended, self.steps >= 20, {}

    def seen(self):
        return np.array([self.place], np.float32)


def place_of(observation):
    return int(observation[0])


def actions_of(policy):
    return [policy(np.array([place], np.float32)) for place in range(1, 6)]


def test_it_learns_the_way_and_stores_no_code():
    learner = DQNLearner(1500, **TRAINED)
    learnt = learner(Corridor(6), ActionPrior(2), None)
    assert actions_of(learnt) == [1] * 5
    assert actions_of(learner.from_bytes(learnt.to_bytes())) == [1] * 5
    # One step of training: what it starts from is what it does.
    assert actions_of(DQNLearner(1, **FAST)(Corridor(0), ActionPrior(2), learnt)) == [1] * 5


def test_it_explores_by_the_prior_of_the_features():
    contexts, prior = BatchContexts(place_of), ActionPrior(2, alpha0=1e-9)
    codes = contexts(np.arange(7, dtype=np.float32)[:, None])
    prior.update(codes, np.tile([True, False], (7, 1)))
    env = Corridor(0)
    taken = []
    step = env.step
    env.step = lambda action: (taken.append(int(action)), step(action))[1]
    DQNLearner(90, contexts, **FAST)(env, prior, None)
    assert set(taken) == {0}


def test_a_life_keeps_its_policies(tmp_path):
    # Two types, and back: the policy of the first comes out of memory and earns the pay at once.
    def life():
        return LongLivedAgent(
            key="corridor", memory=tmp_path / "lake.db", state=place_of, features=place_of, episodes=8,
            max_steps=20, learner=DQNLearner(1500, BatchContexts(place_of), **TRAINED),
        )  # fmt: skip

    with life() as agent:
        first = agent.live(Corridor(6), context="north")
        second = agent.live(Corridor(0), context="south")
    assert first.new
    assert second.new
    with life() as agent:
        again = agent.live(Corridor(6), context="north")
    assert (again.new, again.type) == (False, first.type)
    assert again.returns[0] > 0.5


def test_what_it_does_not_take_is_refused():
    with pytest.raises(InputError, match="steps must be at least 1, got 0"):
        DQNLearner(0)
    env = Corridor(0)
    env.observation_space = Dict({"place": Corridor.observation_space})
    with pytest.raises(InputError, match="observations must be an array"):
        DQNLearner(10)(env, ActionPrior(2), None)
