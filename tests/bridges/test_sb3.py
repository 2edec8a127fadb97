"""A prior in Stable-Baselines3: the law of its actions, each environment for itself, masks, and what is saved."""

import gymnasium
import numpy as np
import pytest
from gymnasium.spaces import Box, Dict, Discrete

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

pytest.importorskip("stable_baselines3")
torch = pytest.importorskip("torch")
contrib = pytest.importorskip("sb3_contrib")

from sb3_contrib import MaskablePPO  # noqa: E402
from stable_baselines3 import DQN  # noqa: E402
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize  # noqa: E402

from lifelore.bridges.sb3 import PriorDQN, PriorMask  # noqa: E402

pytestmark = pytest.mark.deep

N = 3


class Ring(gymnasium.Env):
    """Six places in a ring; action 0 stays, 1 goes on, 2 goes back; place 5 ends the episode and pays 1."""

    observation_space = Box(0.0, 5.0, (1,), np.float32)
    action_space = Discrete(N)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place, self.steps = int(self.np_random.integers(5)), 0
        return self._seen(), {}

    def step(self, action):
        self.place, self.steps = (self.place + (0, 1, -1)[int(action)]) % 6, self.steps + 1
        return self._seen(), float(self.place == 5), self.place == 5, self.steps >= 20, {}

    def _seen(self):
        return np.array([self.place], np.float32)


class DictRing(Ring):
    """The same, told as a dict."""

    observation_space = Dict({"place": Ring.observation_space, "noise": Box(0.0, 1.0, (2,), np.float32)})

    def _seen(self):
        return {"place": super()._seen(), "noise": np.zeros(2, np.float32)}


def places(observations):
    return observations[:, 0].astype(np.int64)


def dict_places(observations):
    return places(observations["place"])


def one_action_a_place():
    """Of place p, action p mod 3 alone is counted."""
    prior = ActionPrior(N)
    prior.update(np.arange(6), np.eye(N, dtype=bool)[np.arange(6) % N])
    return prior


def new_model(env=None, prior=None, contexts=places, policy="MlpPolicy", **settings):
    settings = {"learning_starts": 0, "seed": 3, "device": "cpu", "policy_kwargs": {"net_arch": [8]}, **settings}
    prior = one_action_a_place() if prior is None else prior
    return PriorDQN(policy, env or Ring(), prior=prior, contexts=contexts, buffer_size=2000, **settings)


def strictly(**settings):
    """A model whose every exploring step takes the only counted action."""
    return new_model(form="support", form_settings={"escape": 0.0}, **settings)


def always(model, action):
    """Make the network prefer one action everywhere."""
    with torch.no_grad():
        for weights in model.q_net.parameters():
            weights.zero_()
        model.q_net.q_net[-1].bias[action] = 1.0
    return model


def lived(model):
    """Places and actions in the replay buffer, one row a step and environment."""
    kept = model.replay_buffer
    seen = kept.observations["place"] if isinstance(kept.observations, dict) else kept.observations
    return seen[: kept.pos].reshape(-1).astype(int), kept.actions[: kept.pos].reshape(-1)


def test_actions_follow_the_law_of_the_prior():
    prior = ActionPrior(N, alpha0=0.5)
    prior.update([0] * 7 + [1] * 3, np.eye(N, dtype=bool)[[0, 0, 0, 0, 1, 1, 2, 1, 1, 2]])
    model = new_model(prior=prior)
    model.exploration_rate = 1.0
    seen = np.repeat([[0.0], [1.0], [4.0]], 20_000, axis=0).astype(np.float32)
    actions, _ = model.predict(seen)
    shares = [np.bincount(part, minlength=N) / 20_000 for part in np.split(actions, 3)]
    # (4, 2, 1) and (0, 2, 1) counted, a half for each action; place 4 was never counted. Four deviations: 0.014.
    expected = [[4.5 / 8.5, 2.5 / 8.5, 1.5 / 8.5], [0.5 / 4.5, 2.5 / 4.5, 1.5 / 4.5], [1 / 3] * 3]
    assert np.abs(np.array(shares) - expected).max() < 0.015


@pytest.mark.parametrize("starts", [0, 10_000])
def test_warm_up_and_exploration_are_both_the_priors(starts):
    model = strictly(learning_starts=starts, exploration_initial_eps=1.0, exploration_final_eps=1.0)
    model.exploration_rate = 1.0  # before its first step the base class has none
    seen, actions = lived(model.learn(300))
    assert len(seen) == 300
    assert (actions == seen % N).all()


def test_each_environment_explores_for_itself():
    prior = ActionPrior(N)
    prior.update([0], [[False, False, True]])
    model = always(strictly(prior=prior), 1)
    model.exploration_rate = 0.3
    actions, _ = model.predict(np.zeros((10_000, 1), np.float32))
    assert set(actions.tolist()) == {1, 2}
    assert np.mean(actions == 2) == pytest.approx(0.3, abs=0.02)  # four deviations
    # The base class takes one decision for all of them.
    assert len({np.mean(DQN.predict(model, np.zeros((50, 1), np.float32))[0] == 1) for _ in range(40)}) >= 2
    assert (model.predict(np.zeros((500, 1), np.float32), deterministic=True)[0] == 1).all()


def test_observations_may_be_dicts():
    model = strictly(
        env=DictRing(),
        contexts=dict_places,
        policy="MultiInputPolicy",
        learning_starts=20,
        exploration_final_eps=1.0,
    )
    model.exploration_rate = 1.0
    seen, actions = lived(model.learn(100))
    assert (actions == seen % N).all()
    assert model.predict({"place": np.array([2.0]), "noise": np.zeros(2)})[0] == 2


def test_contexts_are_of_what_was_before_normalising():
    env = VecNormalize(DummyVecEnv([Ring]), clip_obs=100.0)
    told = []

    def contexts(observations):
        told.append(np.asarray(observations).copy())
        return np.round(observations[:, 0]).astype(np.int64)

    model = strictly(env=env, contexts=contexts, exploration_final_eps=1.0)
    model.exploration_rate = 1.0
    model.learn(100)
    told = np.concatenate(told).ravel()
    assert np.abs(told - np.round(told)).max() < 1e-3
    assert set(np.round(told).astype(int).tolist()) <= set(range(5))
    assert len(set(np.round(told))) > 1


def test_the_same_seed_learns_the_same_and_another_not():
    def learnt(seed):
        model = new_model(seed=seed, exploration_fraction=1.0, learning_starts=50)
        model.learn(200)
        return lived(model)[1].tolist(), [w.tolist() for w in model.q_net.parameters()]

    assert learnt(5) == learnt(5)
    assert learnt(5)[0] != learnt(6)[0]


def test_what_was_saved_goes_on(tmp_path):
    model = strictly(exploration_final_eps=1.0)
    model.learn(60)
    model.save(tmp_path / "model")
    again = PriorDQN.load(tmp_path / "model", env=Ring())
    assert again.form == "support"
    assert again.form_settings == {"escape": 0.0}
    assert again.prior.counts(range(6)).tolist() == model.prior.counts(range(6)).tolist()
    seen, actions = lived(again.learn(100))
    assert (actions == seen % N).all()
    other = ActionPrior(N)
    assert PriorDQN.load(tmp_path / "model", prior=other).prior is other


def test_a_plain_dqn_loads_with_a_prior_and_not_without(tmp_path):
    DQN("MlpPolicy", Ring(), buffer_size=10).save(tmp_path / "plain")
    prior = one_action_a_place()
    model = PriorDQN.load(tmp_path / "plain", prior=prior, contexts=places)
    model.exploration_rate = 1.0
    assert model.predict(np.array([[1.0], [2.0]]))[0].shape == (2,)
    with pytest.raises(InputError, match="prior and contexts must be given"):
        PriorDQN.load(tmp_path / "plain")


def test_what_is_refused():
    with pytest.raises(InputError, match="prior and contexts must be given"):
        PriorDQN("MlpPolicy", Ring(), prior=ActionPrior(N))
    with pytest.raises(
        InputError, match=r"prior must be for the environment's actions Discrete\(3\), got one for 4"
    ):
        new_model(prior=ActionPrior(4))


# ---- masks ---------------------------------------------------------------------------------------------


def test_maskable_ppo_keeps_to_the_masks():
    def made():
        return PriorMask(Ring(), one_action_a_place(), places, escape=0.0)

    model = MaskablePPO(
        "MlpPolicy", DummyVecEnv([made] * 2), n_steps=64, batch_size=32, n_epochs=1, seed=0, device="cpu"
    )
    model.learn(128)
    kept = model.rollout_buffer
    seen, actions = kept.observations.reshape(-1).astype(int), kept.actions.reshape(-1)
    assert len(seen) == 128
    assert (actions == seen % N).all()
