"""Who lives beside whom: the agent, its halves, and the baselines it is held against."""

from dataclasses import dataclass, field

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.learning.model_learning import ExplorationStrategy


@dataclass(frozen=True)
class Kind:
    """What an agent brings to a task.

    uses_prior : an action prior orders what is tried
    remembers : transitions learnt in earlier tasks are still known
    manner : how it looks for the goal
    """

    uses_prior: bool = False
    remembers: bool = False
    manner: ExplorationStrategy = field(default_factory=ExplorationStrategy)


ROSTER = {
    "lore": Kind(uses_prior=True, remembers=True),
    "model": Kind(remembers=True),
    "prior": Kind(uses_prior=True),
    "scratch": Kind(),
    "undirected": Kind(manner=ExplorationStrategy(planned=False)),
    "rmax": Kind(manner=ExplorationStrategy(exhaustive=True)),
    "frontier": Kind(manner=ExplorationStrategy(senses=True)),
}
"""`scratch` has everybody's planner and nothing else. `undirected` takes the least-tried move, unplanned; `rmax`
prefers any unknown to a known goal; `frontier` is told what its sensors mean: a visit shows where moves lead."""

Q_AGENTS = ("lore", "prior", "scratch")
"""A Q-learner keeps no model: with the prior it is `lore` and `prior` alike, without it is scratch."""


def companions(agent: str, learner: str) -> list[str]:
    """Names of the agents that live when `agent` is asked for, the one that memory keeps first."""
    if agent != "all" and agent not in ROSTER:
        raise NotFoundError(f"agent must be one of {', '.join(ROSTER)}, all; got '{agent}'")
    if learner == "q":
        if agent not in (*Q_AGENTS, "all"):
            raise InputError(f"learner 'q' has agents {', '.join(Q_AGENTS)}, got '{agent}': use learner 'model'")
        if agent == "all":
            return ["lore", "scratch"]
    if agent == "all":
        return list(ROSTER)
    return ["scratch"] if agent == "scratch" else [agent, "scratch"]
