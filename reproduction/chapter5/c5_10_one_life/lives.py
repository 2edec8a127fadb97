"""Lives of the agents in the tasks of one family: what `LongLivedAgent` and its ablations earn in each task."""

from collections import Counter
from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from threading import Event
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.known_types import KnownTypes
from lifelore.agent.any_tasks.long_lived_agent import LongLivedAgent
from lifelore.agent.any_tasks.moves import MoveCodes
from lifelore.agent.any_tasks.one_task import OneTask
from lifelore.agent.any_tasks.task_result import TaskResult
from reproduction.chapter5.c5_10_one_life.worlds import FAMILIES

FULL, SCRATCH, TEXTBOOK = "full", "scratch", "textbook"
PARTS = {"prior": "no-prior", "reuse": "no-reuse", "context": "no-context"}
"""The ablation by the part that it lacks."""
AGENTS = (FULL, *PARTS.values(), SCRATCH, TEXTBOOK)
WITHIN = 3
"""Episodes after which a type must be recognised."""
DIGITS = 4
"""Decimal places of stored returns."""


def drawn_tasks(family: str, life: int, n_tasks: int) -> tuple[list[str], list[int]]:
    """The hidden types and the contexts of the tasks of a life."""
    draws = [FAMILIES[family].stream(life).draw(number) for number in range(n_tasks)]
    return [one.hidden_type for one in draws], [one.context for one in draws]


def agent_of(family: str, agent: str, life: int, false_alarm: float) -> LongLivedAgent:
    """An agent at the begin of a life."""
    own = FAMILIES[family]
    return LongLivedAgent(
        key=family,
        state=own.state,
        features=own.features,
        learner=own.learner,
        episodes=own.episodes,
        max_steps=own.max_steps,
        discount=own.discount,
        agent=agent,
        seed=life,
        false_alarm=false_alarm,
    )


def lived(family: str, agent: str, life: int, n_tasks: int, false_alarm: float) -> dict:
    """First and mean returns of the tasks of a life, and of the whole agent also what it thought.

    Of the whole agent: ``informed``, what an agent with the same library that knows the type earns in the first
    episode of each task; None where the library lacks the type. ``named``, ``new`` and ``alarm`` by task, and
    ``soon``, the most believed type after `WITHIN` episodes.
    """
    one = agent_of(family, agent, life, false_alarm)
    found: dict[str, list] = {"first": [], "mean": []}
    thought: dict[str, list] = {"informed": [], "named": [], "new": [], "alarm": [], "soon": []}
    types, contexts = drawn_tasks(family, life, n_tasks)
    for number, (hidden, context) in enumerate(zip(types, contexts, strict=True)):
        if agent == FULL:
            thought["informed"].append(_informed(one, family, life, types[: number + 1], thought["named"]))
        with closing(FAMILIES[family].make(hidden, life)) as env:
            result = one.live(env, context=context)
        found["first"].append(_rounded(result.returns[0]))
        found["mean"].append(_rounded(np.mean(result.returns)))
        if agent == FULL:
            thought["named"].append(result.type)
            thought["new"].append(result.new)
            thought["alarm"].append(result.alarm)
            thought["soon"].append(_most_believed(result.beliefs))
    return found | (thought if agent == FULL else {})


def own_name(types: Sequence[str], named: Sequence[str]) -> str | None:
    """The agent's name of the last type: the most frequent in earlier tasks of this type, the first of equals.

    Parameters
    ----------
    types : sequence of str
        Hidden types, that of the current task last.
    named : sequence of str
        What the agent took the earlier tasks for.
    """
    names = Counter(name for hidden, name in zip(types[:-1], named, strict=True) if hidden == types[-1] and name)
    return names.most_common(1)[0][0] if names else None


def _informed(
    one: LongLivedAgent, family: str, life: int, types: Sequence[str], named: Sequence[str]
) -> float | None:
    name = own_name(types, named)
    if name is None:
        return None
    with closing(FAMILIES[family].make(types[-1], life)) as env:
        return _rounded(first_return_told(one, env, name, len(types) - 1))


class ToldTask(OneTask):
    """A task whose type somebody tells: nothing is recognised or learnt, and no alarm is raised."""

    told: str

    @property
    def alarmed(self) -> bool:
        """Never."""
        return False

    def prior_over(self, known: KnownTypes) -> NDArray[np.float64]:
        """Certainty of the told type."""
        return np.array([float(self.told in one.members) for one in known.types])

    def remember(self, name: str) -> None:
        """Nothing."""


def first_return_told(agent: LongLivedAgent, env: gymnasium.Env, name: str, number: int) -> float:
    """What an agent earns in the first episode of a task whose type, of this name, it is told."""
    world = agent.world(env)
    once = replace(agent.settings, learning=replace(agent.settings.learning, episodes=1))
    result = TaskResult(number, None)
    task = ToldTask(agent.experience_for(world.n_actions), world, MoveCodes(), once, result, 0, Event())
    task.told = name.split("+")[0]
    task.live("")
    return result.returns[0]


def _most_believed(beliefs: Sequence[dict[str, float]]) -> str | None:
    if not beliefs:
        return None
    belief = beliefs[min(WITHIN, len(beliefs)) - 1]
    return max(belief, key=belief.__getitem__) if belief else None


def _rounded(value: Any) -> float:
    return round(float(value), DIGITS)
