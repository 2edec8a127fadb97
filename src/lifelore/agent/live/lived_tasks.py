"""What a life asks of its kind of tasks: `SearchedTasks` or `DrivenTasks`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from threading import Event
from typing import Any, Protocol

from lifelore.agent.live.driven.drive_job import DrivenJob
from lifelore.agent.live.goals.own_places import OwnGoal
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.task_result import TaskResult
from lifelore.core.protocols import Record

SEARCHED, DRIVEN = "searched", "driven"
"""How a goal is reached: it is hidden, or the robot knows where it is."""

Result = TaskResult | DrivenJob


@dataclass(frozen=True, eq=False)
class LivedByAll:
    """A task after all agents have lived it.

    goal : state
    results : agent to its result
    records : what the first agent learnt, for memory
    report : keys of the task's report
    document : keys of the task's description in memory alone
    """

    goal: int
    results: Mapping[str, Result]
    records: Sequence[Record]
    report: Mapping[str, Any]
    document: Mapping[str, Any] = field(default_factory=dict)


class TasksOfLife(Protocol):
    """The tasks of a life, and the knowledge of the agents that live them.

    how : `SEARCHED` or `DRIVEN`
    names : of the agents; memory stores the knowledge of the first
    """

    how: str
    names: list[str]

    @property
    def lore(self) -> Lore:
        """Knowledge of the first agent."""
        ...

    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""
        ...

    def live(self, number: int, seq: int, own: OwnGoal | None, stop: Event) -> LivedByAll:
        """Live task `number`, which is number `seq` of this run; the goal is drawn without an `own` one."""
        ...

    def summary(self, tasks: list[dict]) -> dict:
        """The key ``summary`` of a report with these tasks, at least one."""
        ...
