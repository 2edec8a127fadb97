"""A long life in one family of tasks: recall, live task after task, store each in one transaction."""

import os
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Event
from typing import Any

import numpy as np

from lifelore.action.priors.action_prior import KIND
from lifelore.agent.long_lived.curiosity import context_to_practise
from lifelore.agent.long_lived.explanation import episodes_document, task_document
from lifelore.agent.long_lived.families.by_name import family_named
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.task_family import AGENTS, ChangingFamily, TaskFamily
from lifelore.agent.long_lived.task_log import TaskLog
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress, Record
from lifelore.core.streams import stream
from lifelore.memory import Memory, open_memory


@dataclass(frozen=True)
class LongLifeSettings:
    """Settings of a long life.

    Parameters
    ----------
    domain : str
        A name of `families.by_name.FAMILIES`.
    agent : str
        A name of `task_family.AGENTS`; only ``"full"`` stores what it learns.
    n_tasks : int
        Tasks to live through now, at least 1.
    seed : int
        Draws the world, the tasks and the agent's choices.
    robot : str
        Name of the robot in memory.
    memory : str, optional
        A file or a ``postgresql://`` URL; default: the user's own memory.
    living : LivingSettings
        With its `change` above 0, the hidden type does change within tasks so often (factory-customers alone).
    labelled : bool
        Whether the points of the pictures carry the objects' labels, for ``tabletop``.
    n_spare : int
        Number of further tasks, of spare time, in contexts that the agent is curious about, at least 0.
    refresh : bool
        Whether to recall before each task what other robots and processes have stored.

    Raises
    ------
    InputError, NotFoundError
        A setting breaks its rule.
    """

    domain: str
    agent: str = "full"
    n_tasks: int = 20
    seed: int = 0
    robot: str = "robot"
    memory: str | None = None
    living: LivingSettings = field(default_factory=LivingSettings)
    labelled: bool = False
    n_spare: int = 0
    refresh: bool = False

    def __post_init__(self) -> None:
        if self.agent not in AGENTS:
            raise NotFoundError(f"agent must be one of {', '.join(AGENTS)} in {self.domain}, got {self.agent!r}")
        if self.n_tasks < 1:
            raise InputError(f"tasks must be at least 1, got {self.n_tasks}")
        if self.n_spare < 0:
            raise InputError(f"spare must be at least 0, got {self.n_spare}")
        if self.n_spare and self.agent != "full":
            raise InputError(
                f"spare tasks are chosen by what memory holds; the agent must be full, got {self.agent}"
            )

    def family(self) -> TaskFamily:
        """The family of tasks."""
        return family_named(self.domain, self.seed, labelled=self.labelled, change=self.living.change)


def live_long(
    settings: LongLifeSettings,
    progress: Progress | None = None,
    stop: Event | None = None,
    watch: Callable[[dict[str, Any]], None] | None = None,
    family: TaskFamily | None = None,
) -> dict[str, Any]:
    """Live through tasks of a family, and store after each what it taught.

    Parameters
    ----------
    settings : LongLifeSettings
    progress : callable, optional
        Called as ``progress(done, total, label)`` before the first task and after each.
    stop : threading.Event, optional
        Set it to stop after the present task.
    watch : callable, optional
        Called with the document of each task after memory has stored it.
    family : TaskFamily, optional
        Tasks to live through, in place of those of the settings.

    Returns
    -------
    dict
        JSON data: ``domain``, ``agent``, ``tasks`` (a document for each task), ``summary`` (how far first and last
        episodes were below the best possible return, over the first and second half of the tasks).

    Raises
    ------
    InputError, NotFoundError, MissingExtraError
        A setting breaks its rule; MuJoCo is missing.
    StoreError
        Memory cannot store a task; earlier tasks stay stored.
    """
    family, abilities = family or settings.family(), AGENTS[settings.agent]
    process = f"{os.getpid()}-{uuid.uuid4().hex[:12]}"
    documents: list[dict[str, Any]] = []
    with open_memory(settings.memory) as memory:
        knowledge = recalled(family, memory) if settings.agent == "full" else Knowledge.empty(family)
        n_tasks = settings.n_tasks + settings.n_spare
        if progress:
            progress(0, n_tasks, "")
        for done in range(n_tasks):
            if stop is not None and stop.is_set():
                break
            with memory.taken_task(settings.robot, process=process) as number:
                if not abilities.memory:
                    knowledge = Knowledge.empty(family)
                elif settings.refresh and settings.agent == "full" and done:
                    knowledge = recalled(family, memory)
                context = None
                if done >= settings.n_tasks:
                    context = context_to_practise(knowledge, stream(settings.seed, "spare time", number))
                drawn, task = family.meet(number, abilities, context)
                name = f"{settings.robot}.{number}"
                lived, records = live_task(knowledge, drawn, task, abilities, settings.living, name, settings.seed)
                best = family.best_return(number, context)
                document = task_document(lived, family, best) | {"spare": context is not None}
                if isinstance(family, ChangingFamily) and settings.living.change:
                    document |= episodes_document(
                        lived, family.episodes(number, settings.living.n_episodes, context)
                    )
                _store(memory, settings, records, process, done, number, document)
            documents.append(document)
            if watch:
                watch(document)
            if progress:
                progress(done + 1, n_tasks, f"task {number}: {_headline(lived, best)}")
    return {
        "domain": settings.domain,
        "agent": settings.agent,
        "seed": settings.seed,
        "tasks": documents,
        "summary": summary(documents),
    }


def _store(
    memory: Memory,
    settings: LongLifeSettings,
    records: list[Record],
    process: str,
    seq: int,
    number: int,
    document: dict[str, Any],
) -> None:
    """Store a task; an ablation stores its documents alone, so that it teaches no other agent."""
    memory.contribute(
        settings.robot,
        records if settings.agent == "full" else [],
        process=process,
        seq=seq,
        task=document | {"domain": settings.domain, "seed": settings.seed},
        taken=number,
    )


def _headline(lived: TaskLog, best: float) -> str:
    new = ", a new type" if lived.alarm else ""
    return f"{lived.returns[0]:.1f} at first, best {best:.1f}{new}"


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
    best = [task.get("best_returns", [task["best_return"]])[episode] for task in tasks]
    return round(
        float(np.mean([high - task["returns"][episode] for high, task in zip(best, tasks, strict=True)])), 4
    )


def stored_task(number: int, robot: str = "robot", memory: str | None = None) -> dict[str, Any]:
    """The document of a task that a robot has lived through.

    Raises
    ------
    NotFoundError
        The robot has no such task of a long life in this memory.
    StoreError
        There is no memory.
    """
    with open_memory(memory, create=False) as opened:
        for document in opened.task_descriptions(robot):
            if document.get("task") == number and "first_episode" in document:
                return document
    raise NotFoundError(
        f"robot {robot!r} has no task {number} of jobs with hidden types in this memory; "
        "lifelore live --domain tabletop lives through some"
    )
