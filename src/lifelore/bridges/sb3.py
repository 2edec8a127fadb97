"""Action priors in Stable-Baselines3 (extra ``deep``): exploration of DQN, action masks of MaskablePPO.

`contexts` is a function that maps a batch of observations, an array (n, …) or a dict of arrays, to (n,) integers:
the context codes of the prior. Thesis: §3.2.2, Alg. 2 and 4, for a learner whose Q-function is a network.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.cached_prior_sampler import CachedPriorSampler
from lifelore.bridges.observations import Contexts, as_batch, batch_size, check_actions
from lifelore.bridges.prior_mask import PriorMask as PriorMask
from lifelore.core.errors import InputError, MissingExtraError
from lifelore.core.streams import stream

try:
    from stable_baselines3 import DQN  # pyright: ignore[reportMissingImports]
except ImportError as error:
    raise MissingExtraError(
        f"Stable-Baselines3 comes with the extra deep: pip install 'lifelore[deep]' ({error})"
    ) from None


class PriorDQN(DQN):
    """DQN that explores by a prior: always in the warm-up, then in each environment separately with probability ε.

    Parameters
    ----------
    policy, env, *args, **settings
        As Stable-Baselines3's ``DQN``.
    prior : ActionPrior
        Counts added while learning take effect in the next episode. The prior is saved with the model.
    contexts : callable
        Gets the observations of the policy before ``VecNormalize``.
    form : str
        See `lifelore.action.priors.action_prior.FORMS`.
    form_settings : dict, optional
        ``beta`` or ``escape`` of that form.

    Raises
    ------
    InputError
        Prior or contexts are missing, or the prior is for another number of actions.

    Notes
    -----
    Stable-Baselines3 decides once for all environments of a step whether to explore. Here each environment decides
    separately, so that a step of many environments is as varied as many steps of one environment. With one
    environment the distribution is the same.
    """

    def __init__(
        self,
        policy: Any,
        env: Any,
        *args: Any,
        prior: ActionPrior | None = None,
        contexts: Contexts | None = None,
        form: str = "proportion",
        form_settings: dict[str, float] | None = None,
        **settings: Any,
    ) -> None:
        # Before the base class, which may set up the model at once; `load` sets these later.
        self.prior, self.contexts, self.form, self.form_settings = prior, contexts, form, dict(form_settings or {})
        super().__init__(policy, env, *args, **settings)

    def _setup_model(self) -> None:
        if self.prior is None or self.contexts is None:
            raise InputError("prior and contexts must be given, got None; pass PriorDQN(..., prior=, contexts=)")
        check_actions(self.prior, self.action_space)
        self._draws, self._drawn_in = CachedPriorSampler(self.prior, self.form, self.form_settings), -1
        super()._setup_model()

    def set_random_seed(self, seed: int | None = None) -> None:
        """Seed everything the base class seeds, and the exploration."""
        super().set_random_seed(seed)
        self._explorer = np.random.default_rng() if seed is None else stream(seed, "sb3", "exploration")

    def _excluded_save_params(self) -> list[str]:
        return [*super()._excluded_save_params(), "_explorer", "_draws"]

    def _setup_learn(self, *args: Any, **settings: Any) -> Any:
        self._draws.forget()
        return super()._setup_learn(*args, **settings)

    def _sample_action(self, learning_starts: int, action_noise: Any = None, n_envs: int = 1) -> tuple[Any, Any]:
        if self._drawn_in != self._episode_num:
            self._drawn_in = self._episode_num
            self._draws.forget()
        rate = 1.0 if self.num_timesteps < learning_starts else self.exploration_rate
        actions = self._chosen(self._last_obs, rate)
        return actions, actions

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = False
    ) -> tuple[Any, Any]:
        """Actions, and the state. Unless `deterministic`, each action comes from the prior with probability ε."""
        if deterministic or self.exploration_rate <= 0:
            return self.policy.predict(observation, state, episode_start, deterministic)
        self._draws.forget()
        if self.policy.is_vectorized_observation(observation):
            return self._chosen(observation, self.exploration_rate), state
        return self._chosen(as_batch(observation), self.exploration_rate).squeeze(axis=0), state

    def _chosen(self, observations: Any, rate: float) -> NDArray[np.int64]:
        n = batch_size(observations)
        exploring = [place for place in range(n) if self._explorer.random() < rate]
        if len(exploring) == n:
            return self._draws_of(observations, exploring)
        actions, _ = self.policy.predict(observations)
        if exploring:
            actions = np.array(actions)
            actions[exploring] = self._draws_of(observations, exploring)
        return actions

    def _draws_of(self, observations: Any, places: list[int]) -> NDArray[np.int64]:
        if self._vec_normalize_env is not None:
            observations = self._vec_normalize_env.unnormalize_obs(observations)
        assert self.contexts is not None
        codes = np.asarray(self.contexts(observations)).tolist()
        return np.array([self._draws.draw(codes[place], self._explorer) for place in places], np.int64)
