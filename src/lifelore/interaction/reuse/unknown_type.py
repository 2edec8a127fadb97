"""The probability that no type of a library fits a task: Bayes' rule between the known types and a broad law.

    log odds = log mass / (1 − mass) + Σ log q(σ) − Σ log m(σ)

q is the broad law (`library.broad_law`) and m the types of the library, each given the task's earlier signals. In
m a task is just like its type: its parameters are in doubt only as far as the runs leave them. An agent's own
models may allow more. Where the runs do not tell tasks apart, they also allow tasks between the types. They then
fit almost any task, and their evidence is no sign of a new type. Hence this record has a belief of its own. It
never changes the agent's belief.
"""

from math import exp, log, log1p
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.broad_law import BroadLaw, broad_law
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.signal_laws import signal_laws
from lifelore.interaction.reuse.explanation import surprise_of
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm

MASS = 0.05
"""Usual prior probability that no known type fits."""


class UnknownType:
    """The evidence of one task that no known type fits.

    Parameters
    ----------
    library : PolicyLibrary
        Read once: what it learns later does not count.
    mass : float
        Prior probability that no known type fits, in (0, 1).
    prior : (n_types,) float, optional
        Of the known types; the library's by default.
    dynamics : TypeDynamics, optional
        As for an agent.
    models : {"uncertain", "plug-in"}
        Whether parameters of known types are as uncertain as the runs leave them, or taken for exact.

    Attributes
    ----------
    log_odds : float
        Evidence of the broad law over that of the types, in nats, without the prior.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories, or the mass breaks its rule.
    """

    def __init__(
        self,
        library: PolicyLibrary,
        mass: float = MASS,
        prior: ArrayLike | None = None,
        dynamics: TypeDynamics | None = None,
        models: str = "uncertain",
    ) -> None:
        if not 0 < mass < 1:
            raise InputError(f"novelty must lie between 0 and 1, the prior that no known type fits, got {mass}")
        self.mass, self.log_odds = float(mass), 0.0
        self._laws = signal_laws(library)
        self._broad: BroadLaw = broad_law(library, self._laws)
        self._shown: dict[int, NDArray[np.float64]] = {}
        self._types = closest_types(library, prior, dynamics, models)

    def observe(self, policy: int, signal: Any) -> None:
        """Take in the signal of a policy; errors as for an agent's `observe`."""
        log_evidence = self._types.observe(0, policy, signal).log_evidence
        number, policies = self._laws.numbers([signal]), np.array([policy])
        shown = self._shown.setdefault(policy, np.zeros((1, self._broad.width)))
        self.log_odds += float(self._broad.log_density(shown, policies, number)[0]) + surprise_of(
            float(log_evidence)
        )
        self._broad.learn(shown, number)

    def end_episode(self) -> None:
        """End an episode."""
        self._types.end_episode(0)

    @property
    def probability(self) -> float:
        """Probability that no known type fits, in [0, 1]."""
        log_odds = self.log_odds + log(self.mass) - log1p(-self.mass)
        return 1 / (1 + exp(-log_odds)) if log_odds > 0 else exp(log_odds) / (1 + exp(log_odds))

    def state(self) -> dict[str, NDArray[Any]]:
        """What the task has shown: ``numbers`` (mass, log odds), ``log_belief``, ``policies`` (m,), ``shown``."""
        return {f"task.{name}": array for name, array in self._types.state(0).items()} | {
            "numbers": np.array([self.mass, self.log_odds]),
            "log_belief": self._types.log_belief[0].copy(),
            "policies": np.array(list(self._shown), np.int64),
            "shown": np.array(list(self._shown.values())).reshape(-1, self._broad.width),
        }

    @classmethod
    def restored(
        cls, state: dict[str, NDArray[Any]], library: PolicyLibrary, dynamics: TypeDynamics, models: str
    ) -> "UnknownType":
        """The evidence of a `state`, bit for bit; InputError where it is not of this library."""
        try:
            mass, log_odds = np.asarray(state["numbers"], np.float64).tolist()
            found = cls(library, mass, None, dynamics, models)
            policies, shown = np.asarray(state["policies"], np.int64), np.array(state["shown"], np.float64)
            parts = {
                name.removeprefix("task."): array for name, array in state.items() if name.startswith("task.")
            }
            found._types.restore(0, state["log_belief"], parts)
        except (KeyError, ValueError, TypeError) as error:
            raise InputError(f"this is no evidence of an unknown type of this library: {error}") from None
        numbers = [log_odds, *shown.ravel()]
        if shown.shape != (len(policies), found._broad.width) or not np.isfinite(numbers).all():
            raise InputError("the evidence of an unknown type is of another library")
        if policies.size and not 0 <= policies.min() <= policies.max() < library.n_policies:
            raise InputError(f"the evidence of an unknown type must be of policies 0 to {library.n_policies - 1}")
        found.log_odds = log_odds
        found._shown = {policy: row[None].copy() for policy, row in zip(policies.tolist(), shown, strict=True)}
        return found


def closest_types(library: PolicyLibrary, prior: Any, dynamics: Any, models: Any) -> ReuseAlgorithm:
    """Algorithm 7 for a single user who is as close to a type as the spread of the users of a type allows."""
    usual = ReuseAlgorithm(library, prior=prior, dynamics=dynamics, models=models)
    least = usual.signals.law.spread.least
    return ReuseAlgorithm(library, prior=prior, dynamics=dynamics, models=models, spread=least)
