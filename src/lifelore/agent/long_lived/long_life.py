"""`live_long`: a long life in one family of tasks with hidden types, by the loop that all lives share."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np

from lifelore.action.priors.action_prior import KIND
from lifelore.agent.life.loop import LivedTask, opened_memory, run_life
from lifelore.agent.long_lived.check_family import check_constants, checked_best_return, checked_meeting
from lifelore.agent.long_lived.curiosity import context_to_practise
from lifelore.agent.long_lived.explanation import task_document
from lifelore.agent.long_lived.families.by_name import family_named
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import live_task
from lifelore.agent.long_lived.task_family import AGENTS, TaskFamily
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.memory import Memory, open_memory


def live_long(
    family: TaskFamily | str,
    *,
    tasks: int = 20,
    agent: str = "full",
    episodes: int = 8,
    seed: int = 0,
    memory: Memory | str | Path | None = None,
    robot: str = "robot",
    refresh: bool = False,
    spare: int = 0,
    false_alarm: float = 0.05,
    progress: Progress | None = None,
    stop: Event | None = None,
    watch: Callable[[dict[str, Any]], None] | None = None,
) -> dict[str, Any]:
    """Live through tasks of a family with hidden types, and store after each what it taught.

    Parameters
    ----------
    family : TaskFamily or str
        Your own family (`check_family` looks for its mistakes), or ``"tabletop"``, ``"factory-customers"`` or
        ``"building-days"``.
    tasks : int
        Tasks to live through now, at least 1.
    agent : str
        ``"full"``, or an agent without some part: ``"no-perception"``, ``"no-prior"``, ``"no-reuse"``,
        ``"scratch"`` (which begins each task anew). Only ``"full"`` stores what it learns.
    episodes : int
        Episodes of a task, at least 1.
    seed : int
        Draws the agent's choices, and the world of a family that is given by name.
    memory : Memory, str or Path, optional
        SQLite file or ``postgresql://`` URL that holds earlier lives and stores this one, one transaction a task;
        or a memory that is open. None: start without knowledge and store nothing.
    robot : str
        Name of the robot in memory.
    refresh : bool
        Whether to recall before each task what other robots and processes have stored.
    spare : int
        Tasks of spare time after those, in contexts that the agent is curious about, at least 0.
    false_alarm : float
        Probability of an alarm in a task of a known type, in (0, 1).
    progress : callable, optional
        Called as ``progress(done, total, label)`` before the first task and after each.
    stop : threading.Event, optional
        Set it to stop after the present task.
    watch : callable, optional
        Called with the document of each task after memory has stored it.

    Returns
    -------
    dict
        JSON data: ``domain``, ``agent``, ``seed``, ``tasks`` (a document for each task), ``summary`` (how far
        first and last episodes were below the best possible return, over the first and second half of the tasks).

    Raises
    ------
    InputError, NotFoundError, MissingExtraError
        A setting breaks its rule; the family is wrong in a way that one task shows; MuJoCo is missing.
    StoreError
        Memory cannot store a task; earlier tasks stay stored.

    Examples
    --------
    >>> report = live_long("factory-customers", tasks=1, episodes=2)
    >>> report["summary"].keys() >= {"second half"}
    True
    """
    family = family_named(family, seed) if isinstance(family, str) else family
    check_constants(family)
    _check_settings(family, tasks, agent, episodes, spare, false_alarm)
    with opened_memory(memory) as opened:
        life = _FamilyLife(family, agent, tasks, episodes, false_alarm, seed, robot, opened, watch)
        run_life(life, tasks + spare, memory=opened, robot=robot, refresh=refresh, progress=progress, stop=stop)
    return {
        "domain": family.domain,
        "agent": agent,
        "seed": seed,
        "tasks": life.documents,
        "summary": summary(life.documents),
    }


def _check_settings(
    family: TaskFamily, tasks: int, agent: str, episodes: int, spare: int, false_alarm: float
) -> None:
    if agent not in AGENTS:
        raise NotFoundError(f"agent must be one of {', '.join(AGENTS)} in {family.domain}, got {agent!r}")
    for name, value, least in (("tasks", tasks, 1), ("episodes", episodes, 1), ("spare", spare, 0)):
        if value < least:
            raise InputError(f"{name} must be at least {least}, got {value}")
    if not 0 < false_alarm < 1:
        raise InputError(f"false_alarm must lie between 0 and 1, got {false_alarm}")
    if spare and agent != "full":
        raise InputError(f"spare tasks are chosen by what memory holds; the agent must be full, got {agent}")


@dataclass(eq=False)
class _FamilyLife:
    """A life in progress: the knowledge of one agent; memory stores that of the full one."""

    family: TaskFamily
    agent: str
    n_tasks: int
    n_episodes: int
    false_alarm: float
    seed: int
    robot: str
    memory: Memory | None
    watch: Callable[[dict[str, Any]], None] | None
    documents: list[dict[str, Any]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.knowledge = Knowledge.empty(self.family)

    def recall(self) -> None:
        """Know what all robots of the memory know; an agent without some part knows what it has learnt itself."""
        if self.agent == "full" and self.memory is not None:
            self.knowledge = recalled(self.family, self.memory)

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task; the last tasks, of spare time, in a context of the agent's choice."""
        family, abilities, context = self.family, AGENTS[self.agent], None
        if not abilities.memory:
            self.knowledge = Knowledge.empty(family)
        if seq >= self.n_tasks:
            context = context_to_practise(self.knowledge, stream(self.seed, "spare time", number))
        drawn, task = checked_meeting(family, number, family.meet(number, abilities, context))
        name = f"{self.robot}.{number}"
        lived, news = live_task(
            self.knowledge, drawn, task, abilities, name, n_episodes=self.n_episodes,
            false_alarm=self.false_alarm, seed=self.seed,
        )  # fmt: skip
        records = self.knowledge.learn(news)
        best = checked_best_return(family, number, family.best_return(number, context))
        document = task_document(lived, family, best) | {"spare": context is not None}
        return LivedTask(
            # An agent without some part stores its documents alone, so that it teaches no other agent.
            records if self.agent == "full" else [],
            document | {"domain": family.domain, "seed": self.seed},
            document,
            f"{lived.returns[0]:.1f} at first, best {best:.1f}{', a new type' if lived.alarm else ''}",
        )

    def finish(self, lived: LivedTask) -> None:
        """Report a task."""
        self.documents.append(lived.result)
        if self.watch:
            self.watch(lived.result)


def recalled(family: TaskFamily, memory: Memory) -> Knowledge:
    """The knowledge of a family that a memory holds, of all its robots."""
    keys = [(key, version) for key, version, _ in memory.keys(KIND) if key.startswith(f"{family.name}/")]
    found = [memory.recall(KIND, key, version) for key, version in keys]
    return Knowledge.from_records(family, [record for record in found if record is not None])


def summary(tasks: list[dict[str, Any]]) -> dict[str, Any]:
    """Mean points below the best possible return, in first and last episodes, by half of the tasks."""
    halves = {"first half": tasks[: len(tasks) // 2], "second half": tasks[len(tasks) // 2 :]}
    return {
        name: {
            "tasks": len(half),
            "first_episode_below_best": _below(half, 0),
            "last_episode_below_best": _below(half, -1),
            "new_types": sum(task["new_type"] for task in half),
        }
        for name, half in halves.items()
        if half
    }


def _below(tasks: list[dict[str, Any]], episode: int) -> float:
    return round(float(np.mean([task["best_return"] - task["returns"][episode] for task in tasks])), 4)


def stored_task(number: int, robot: str = "robot", memory: str | None = None) -> dict[str, Any]:
    """The document of a task that a robot has lived through, in a family or as a `LongLivedAgent`.

    Raises
    ------
    NotFoundError
        The robot has no such task of a long life in this memory.
    StoreError
        There is no memory.
    """
    with open_memory(memory, create=False) as opened:
        for document in opened.task_descriptions(robot):
            numbered = document.get("task", document.get("number"))
            if numbered == number and document.keys() & {"first_episode", "policies"}:
                return document
    raise NotFoundError(
        f"robot {robot!r} has no task {number} with a hidden type in this memory; "
        "lifelore live --domain tabletop lives through some"
    )
