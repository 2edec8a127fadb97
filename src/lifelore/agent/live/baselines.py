"""The agents that can live a life: `lore`, its parts, and the baselines it is compared with."""

from dataclasses import dataclass, field

from lifelore.core.errors import NotFoundError
from lifelore.core.learning.model_learning import ExplorationStrategy


@dataclass(frozen=True)
class AgentKind:
    """What an agent uses in a task.

    uses_prior : an action prior orders the moves that it tries
    remembers : it still knows the transitions that it learnt in earlier tasks, and plans a tour on them
    exploration_strategy : how it searches for the goal
    """

    uses_prior: bool = False
    remembers: bool = False
    exploration_strategy: ExplorationStrategy = field(default_factory=ExplorationStrategy)


AGENTS = {
    "lore": AgentKind(uses_prior=True, remembers=True),
    "model": AgentKind(remembers=True),
    "prior": AgentKind(uses_prior=True),
    "scratch": AgentKind(),
    "undirected": AgentKind(exploration_strategy=ExplorationStrategy(planned=False)),
    "rmax": AgentKind(exploration_strategy=ExplorationStrategy(exhaustive=True)),
    "frontier": AgentKind(exploration_strategy=ExplorationStrategy(senses=True)),
}
"""`scratch` has the same planner as the others, without prior and memory. `undirected` does not plan: it takes the
move that it has tried least. `rmax` prefers every unknown move to a known goal. `frontier` knows where all moves
of a cell lead as soon as it has visited the cell."""
BIG = 100_000
"""Number of places above which an agent lives alone unless the settings ask for the comparison."""


def agents_for(agent: str, compare: bool = True) -> list[str]:
    """Names of all agents that live when `agent` is asked for; memory stores the first one's knowledge.

    The others live the same tasks for comparison; with `compare` False the agent lives alone. ``all`` stands for
    `lore` and asks for the baselines by name, so they live in any case.

    Raises
    ------
    NotFoundError
        No agent has this name.
    """
    if agent != "all" and agent not in AGENTS:
        raise NotFoundError(f"agent must be one of {', '.join(AGENTS)}, all; got '{agent}'")
    if agent == "all":
        return list(AGENTS)
    return [agent, "scratch"] if compare and agent != "scratch" else [agent]
