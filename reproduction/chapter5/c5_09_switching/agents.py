"""The agents that are compared: policy reuse by its dynamics, two baselines, and one that knows the type."""

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np

from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse

OURS, OKR, STATIC = "learnt by outcome", "Bayes-OKR", "static"
KNOWS = "knows the type"
HAZARD = 0.002
"""Probability of a new type per episode, the library's default before it was learnt."""


class KnowsType:
    """Selects the best policy for the type, which it is told before each episode as `type`."""

    def __init__(self, library: PolicyLibrary) -> None:
        self._best = library.performance.mean.argmax(axis=1)
        self.type = 0

    def select(self) -> int:
        """The best policy."""
        return int(self._best[self.type])

    def observe(self, policy: int, signal: Any) -> None:
        """Learn nothing."""

    def end_episode(self, outcome: Hashable = None) -> None:
        """Learn nothing."""


def reuse(dynamics: Callable[[PolicyLibrary], TypeDynamics]) -> "Maker":
    """Policy reuse by the default rule, with these dynamics."""
    return lambda library, seed: BayesianPolicyReuse(library, dynamics=dynamics(library), seed=seed)


def learnt(by: str) -> Callable[[PolicyLibrary], TypeDynamics]:
    """Dynamics that learn; a hazard where the library has none."""
    make = getattr(TypeDynamics, "learnt", None)
    return (lambda library: make(by=by)) if make else lambda library: TypeDynamics.hazard(HAZARD, library.prior)


Maker = Callable[[PolicyLibrary, np.random.Generator], Any]
AGENTS: dict[str, Maker] = {
    STATIC: reuse(lambda library: TypeDynamics.static()),
    "hazard 0.002": reuse(lambda library: TypeDynamics.hazard(HAZARD, library.prior)),
    "learnt by time": reuse(learnt("time")),
    OURS: reuse(learnt("outcome")),
    KNOWS: lambda library, seed: KnowsType(library),
}
"""A new agent by its name."""
