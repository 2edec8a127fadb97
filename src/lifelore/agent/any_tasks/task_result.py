"""What happened in a task of `LongLivedAgent`, and the task in words."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

LEARNER = "learner"
"""Stands for the learner among the policies of a task's episodes."""
SHOWN = 3
"""Types that a text names, the most probable ones."""


@dataclass(eq=False)
class TaskResult:
    """What happened in a task.

    Parameters
    ----------
    number : int
        Of the task, from 0.
    context : hashable
        As it was given.
    returns : list of float
        Discounted return of each episode.
    policies : list of str
        With which policy each episode began: that of a type, by its name, or ``"learner"``.
    reached : bool
        Whether an episode was terminated with a positive reward.
    type : str
        Name of the type that the task was taken for at its end; empty where the agent keeps no types.
    new : bool
        Whether the task added this type.
    alarm : bool
        Whether the alarm was raised: outcomes fit no known type.
    alarm_episode : int or None
        Number of the episode in which it was raised.
    prior : dict of str to float
        Over the types that were known before the task, given its context.
    beliefs : list of dict of str to float
        The same at the end of each episode.
    """

    number: int
    context: Any
    returns: list[float] = field(default_factory=list)
    policies: list[str] = field(default_factory=list)
    reached: bool = False
    type: str = ""
    new: bool = False
    alarm: bool = False
    alarm_episode: int | None = None
    prior: dict[str, float] = field(default_factory=dict)
    beliefs: list[dict[str, float]] = field(default_factory=list)

    def to_dict(self) -> dict[str, Any]:
        """As JSON data; the context as text."""
        return asdict(self) | {"context": repr(self.context)}

    def explain(self) -> str:
        """Why the agent acted as it did, in a few lines."""
        return explained_task(self.to_dict())


def explained_task(document: Mapping[str, Any]) -> str:
    """A task in words, from `TaskResult.to_dict` or as memory keeps it."""
    returns = document["returns"]
    n = len(returns)
    lines = [f"task {document['number']}, context {document['context']}, {n} episode{'s' if n != 1 else ''}"]
    if document["prior"]:
        lines.append(f"expected  {_most_probable(document['prior'])}")
        lines.append(f"believed  {_most_probable(document['beliefs'][0])} after the first episode")
    else:
        lines.append("expected  nothing: no type was known, or the agent keeps none")
    if document["alarm"]:
        lines.append(f"alarm     in episode {document['alarm_episode']}: the outcomes fit no known type")
    if document["type"]:
        lines.append(f"taken for {document['type']}{', a new type' if document['new'] else ''}")
    lines.append(f"ran       {_runs(document['policies'])}")
    lines.append(f"returns   {returns[0]:.4g} first, {returns[-1]:.4g} last, mean {sum(returns) / n:.4g}")
    return "\n".join(lines)


def _most_probable(belief: Mapping[str, float]) -> str:
    best = sorted(belief.items(), key=lambda one: -one[1])[:SHOWN]
    return ", ".join(f"{name} {value:.2f}" for name, value in best)


def _runs(policies: list[str]) -> str:
    """Policies in the order of their episodes, each with its number of episodes in a row."""
    runs: list[tuple[str, int]] = []
    for name in policies:
        if runs and runs[-1][0] == name:
            runs[-1] = name, runs[-1][1] + 1
        else:
            runs.append((name, 1))
    return ", ".join(f"{name} × {count}" for name, count in runs)
