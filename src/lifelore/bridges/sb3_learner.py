"""DQN of Stable-Baselines3 as the learner of a `LongLivedAgent` (extra ``deep``); memory keeps its policies."""

import io
from typing import Any

import numpy as np
from gymnasium.spaces import Box, Discrete

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.observations import Contexts
from lifelore.bridges.sb3 import DQN, PriorDQN  # pyright: ignore[reportAttributeAccessIssue]
from lifelore.core.errors import InputError


class DQNPolicy:
    """The greedy policy of a Q-network, from observation to action.

    Parameters
    ----------
    network : torch module
        Stable-Baselines3's policy of a DQN.
    """

    def __init__(self, network: Any) -> None:
        self.network = network

    def __call__(self, observation: Any) -> int:
        """The action of the largest value."""
        return int(self.network.predict(np.asarray(observation), deterministic=True)[0])

    def to_bytes(self) -> bytes:
        """Spaces and weights; no code, so that a memory of others can be read."""
        import torch  # pyright: ignore[reportMissingImports]

        seen, actions = self.network.observation_space, self.network.action_space
        bounds = {name: torch.as_tensor(getattr(seen, name)) for name in ("low", "high")}
        content = bounds | {"n_actions": int(actions.n), "weights": self.network.state_dict()}
        torch.save(content, buffer := io.BytesIO())
        return buffer.getvalue()


class DQNLearner:
    """Learns the policy of a type by DQN: ``LongLivedAgent(learner=DQNLearner(20_000), …)``.

    Exploration is drawn from the agent's action prior where `contexts` are given. Training goes on from the best
    known policy. Observations must be an array (``Box``) and actions numbered from 0.

    Parameters
    ----------
    steps : int
        Steps of training in a task whose policy is learnt, at least 1.
    contexts : callable, optional
        ``BatchContexts(features)`` of the agent's ``features``.
    policy : str
        ``"MlpPolicy"`` or ``"CnnPolicy"``.
    **options
        Of ``PriorDQN`` with `contexts`, else of Stable-Baselines3's ``DQN``.

    Raises
    ------
    InputError
        `steps` is below 1.
    """

    def __init__(
        self, steps: int, contexts: Contexts | None = None, policy: str = "MlpPolicy", **options: Any
    ) -> None:
        if steps < 1:
            raise InputError(f"steps must be at least 1, got {steps}")
        self.steps, self.contexts, self.policy, self.options = steps, contexts, policy, options

    def __call__(self, env: Any, prior: ActionPrior, start: DQNPolicy | None = None) -> DQNPolicy:
        """The policy after training in `env`; InputError for observations that are no array."""
        if not isinstance(env.observation_space, Box):
            raise InputError(f"observations must be an array (Box), got {env.observation_space}; flatten them")
        if self.contexts is None:
            model = DQN(self.policy, env, **self.options)
        else:
            model = PriorDQN(self.policy, env, prior=prior, contexts=self.contexts, **self.options)
        if start is not None:
            model.policy.load_state_dict(start.network.state_dict())
        model.learn(self.steps)
        return DQNPolicy(model.policy)

    def from_bytes(self, content: bytes) -> DQNPolicy:
        """The policy of `DQNPolicy.to_bytes`; this learner must have the network of the one that made it."""
        import torch  # pyright: ignore[reportMissingImports]

        stored = torch.load(io.BytesIO(content), weights_only=True)
        low, high = (stored[name].numpy() for name in ("low", "high"))
        actions = Discrete(stored["n_actions"])
        made = DQN.policy_aliases[self.policy](
            Box(low, high, dtype=low.dtype.type), actions, lambda _: 0.0, **self.options.get("policy_kwargs", {})
        )
        made.load_state_dict(stored["weights"])
        return DQNPolicy(made)
