"""The agents that are compared: policy reuse by its dynamics, two baselines, and an agent that knows the type."""

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np

from lifelore.interaction.baselines import BayesOKR, BPRPlus
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse

STATIC, HAZARD, BY_TIME, OURS = "static", "hazard 0.002", "learnt by time", "learnt by outcome"
OKR, BPR, KNOWS = "Bayes-OKR", "BPR+", "knows the type"
RATE = 0.002
"""Probability of a new type per episode, the library's default before hazards were learnt."""


class Player:
    """An agent in a world; all learn from what their method reads."""

    def select(self) -> int:
        """The policy of the next round or step."""
        raise NotImplementedError

    def observe(self, policy: int, signal: Any, pay: float | None = None) -> None:
        """Learn from a signal; `pay` is what the policy paid, None where only the end of the episode pays."""

    def end_episode(self, outcome: Hashable, pay: float) -> None:
        """End an episode; `pay` is that of its last policy, as the library's performance model knows it."""


class ReusePlayer(Player):
    """Policy reuse by the default rule: it reads signals, and how episodes end."""

    def __init__(self, library: PolicyLibrary, dynamics: Any, seed: np.random.Generator) -> None:
        self._agent: Any = BayesianPolicyReuse(library, dynamics=dynamics, seed=seed)

    def select(self) -> int:
        return self._agent.select()

    def observe(self, policy: int, signal: Any, pay: float | None = None) -> None:
        self._agent.observe(policy, signal)

    def end_episode(self, outcome: Hashable, pay: float) -> None:
        self._agent.end_episode(outcome)


class OkrPlayer(ReusePlayer):
    """Bayes-OKR: it reads signals, and the pay at the end."""

    def __init__(self, library: PolicyLibrary, seed: np.random.Generator) -> None:
        self._agent = BayesOKR(library, seed=seed)

    def end_episode(self, outcome: Hashable, pay: float) -> None:
        self._agent.end_episode(pay)


class BprPlayer(Player):
    """BPR+: it reads pays alone, and holds a policy until it pays."""

    def __init__(self, library: PolicyLibrary, seed: np.random.Generator) -> None:
        self._agent = BPRPlus.from_library(library, seed=seed)
        self._held, self._free, self._paid = 0, True, False

    def select(self) -> int:
        if self._free:
            self._held, self._free = int(self._agent.select()), False
        return self._held

    def observe(self, policy: int, signal: Any, pay: float | None = None) -> None:
        if pay is not None:
            self._agent.update(policy, pay)
            self._free, self._paid = True, True

    def end_episode(self, outcome: Hashable, pay: float) -> None:
        if not self._paid:
            self._agent.update(self._held, pay)
        self._free, self._paid = True, False


class KnowsType(Player):
    """Selects the best policy for the type, which it learns before each episode as its attribute `type`."""

    def __init__(self, library: PolicyLibrary) -> None:
        self._best = library.performance.mean.argmax(axis=1)
        self.type = 0

    def select(self) -> int:
        return int(self._best[self.type])


AGENTS: dict[str, Callable[[PolicyLibrary, np.random.Generator], Player]] = {
    STATIC: lambda library, seed: ReusePlayer(library, TypeDynamics.static(), seed),
    HAZARD: lambda library, seed: ReusePlayer(library, TypeDynamics.hazard(RATE, library.prior), seed),
    BY_TIME: lambda library, seed: ReusePlayer(library, TypeDynamics.learnt(by="time"), seed),
    OURS: lambda library, seed: ReusePlayer(library, TypeDynamics.learnt(by="outcome"), seed),
    OKR: OkrPlayer,
    BPR: BprPlayer,
    KNOWS: lambda library, seed: KnowsType(library),
}
"""A new agent by its name."""
