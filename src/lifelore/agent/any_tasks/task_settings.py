"""The agent's parts, its ablations, and the settings with which a task is lived."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from lifelore.agent.live.life_settings import PriorSettings
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning


class Abilities(NamedTuple):
    """Which parts of the agent work; ablations switch them off.

    prior : the action prior guides exploration
    reuse : types and their policies are remembered and reused
    context : the context of a task tells which types to expect
    memory : anything is carried from task to task
    learner : name of a learner in place of the agent's own
    """

    prior: bool = True
    reuse: bool = True
    context: bool = True
    memory: bool = True
    learner: str | None = None


AGENTS: Mapping[str, Abilities] = {
    "full": Abilities(),
    "no-prior": Abilities(prior=False),
    "no-reuse": Abilities(reuse=False),
    "no-context": Abilities(context=False),
    "scratch": Abilities(prior=False, reuse=False, memory=False),
    "textbook": Abilities(prior=False, reuse=False, memory=False, learner="textbook"),
}
"""The agent, its ablations, and a textbook's Q-learning with ε = 0.1 and no past."""


def check_names(**names: str) -> None:
    """InputError if a name is empty, or has a ``/``, which separates the parts of a key in memory."""
    for name, value in names.items():
        if not value.strip() or "/" in value:
            raise InputError(f"{name} must be a name without '/', got {value!r}")


@dataclass(frozen=True)
class TaskSettings:
    """How a task is lived; the fields as the arguments of `LongLivedAgent`, and what the agent is able to do.

    With ``cautious`` the action prior is trusted as `TableLearner` says.
    """

    learning: QLearning
    guidance: PriorSettings
    discount: float
    learner: Any
    signals: str
    false_alarm: float
    seed: int
    abilities: Abilities
    cautious: bool = True
