"""Action masks from a prior, for learners that ask the environment for a mask of allowed actions."""

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.observations import Contexts, as_batch, check_actions
from lifelore.core.errors import InputError
from lifelore.core.streams import stream


class PriorMask(gymnasium.Wrapper):
    """Masks for sb3-contrib's ``MaskablePPO``: in each context the actions that the prior's `mask` allows.

    Parameters
    ----------
    env : gymnasium.Env
        With ``Discrete`` actions.
    prior : ActionPrior
        Counts added while learning take effect in the next episode.
    contexts : callable
        Maps batches of this environment's observations to context codes.
    threshold : float
        An action is allowed if its share of the counts exceeds the threshold; see `ActionPrior.mask`.
    escape : float
        Probability in [0, 1] that a step has no mask. A mask can exclude the best action
        (`ActionPrior.exclusion_rate` measures how often); only steps without a mask can then find it.

    Raises
    ------
    InputError
        The prior is for another number of actions, or `escape` breaks its rule.

    Examples
    --------
    >>> from lifelore import ActionPrior
    >>> prior = ActionPrior(4)
    >>> prior.update_trajectory([0, 0], [1, 2])  # at the start of the lake: down and right
    >>> env = PriorMask(gymnasium.make("FrozenLake-v1"), prior, np.asarray, escape=0.0)
    >>> observation, info = env.reset(seed=0)
    >>> env.action_masks().tolist()
    [False, True, True, False]
    """

    def __init__(
        self,
        env: gymnasium.Env,
        prior: ActionPrior,
        contexts: Contexts,
        threshold: float = 0.0,
        escape: float = 0.02,
    ) -> None:
        super().__init__(env)
        if not 0 <= escape <= 1:
            raise InputError(f"escape must lie in [0, 1], got {escape}")
        check_actions(prior, env.action_space)
        self.prior, self.contexts, self.threshold, self.escape = prior, contexts, threshold, escape
        self._escapes = np.random.default_rng()
        self._all = self._mask = np.ones(prior.n_actions, bool)
        self._cached: dict[int, NDArray[np.bool_]] = {}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Reset the environment; the seed also selects the steps without a mask."""
        self._cached.clear()
        if seed is not None:
            self._escapes = stream(seed, "sb3", "escape")
        observation, info = self.env.reset(seed=seed, options=options)
        self._look(observation)
        return observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Step the environment, then compute the mask of the new observation."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._look(observation)
        return observation, reward, terminated, truncated, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Actions allowed now, (n_actions,) bool; the same until the next step."""
        return self._mask

    def _look(self, observation: Any) -> None:
        if self._escapes.random() < self.escape:
            self._mask = self._all
            return
        code = int(self.contexts(as_batch(observation))[0])
        if code not in self._cached:
            self._cached[code] = self.prior.mask([code], self.threshold)[0]
        self._mask = self._cached[code]
