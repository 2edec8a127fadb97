"""A life in a grid world or building in progress; `SearchedLife` and `DrivenLife` are its two kinds."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from threading import Event
from typing import Any, NamedTuple

from lifelore.agent.life.loop import LivedTask
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.driven.drive_job import DrivenJob
from lifelore.agent.live.goals.job_progress import JobProgress
from lifelore.agent.live.goals.own_places import OwnGoal, OwnPlaces
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.settings_document import settings_document
from lifelore.agent.live.task_result import TaskResult
from lifelore.core.protocols import Record
from lifelore.memory import Memory

TASKS_WITH_POLICY = 4
"""Last tasks whose policies stay in main memory for the pictures; more cost an array of the world's size each."""
SEARCHED, DRIVEN = "searched", "driven"
"""How a goal is reached: it is hidden, or the robot knows where it is."""

Result = TaskResult | DrivenJob
Watcher = Callable[[dict, dict[str, Result]], None]
"""Called with the report's entry of a finished task, and with the result of each agent."""


class LivedByAll(NamedTuple):
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
    document: Mapping[str, Any]


class GridLife(ABC):
    """Where a life is lived, what its agents know, and what memory stores of its tasks; a `RunningLife`.

    Parameters
    ----------
    settings : LifeSettings
    place : Place
    places : OwnPlaces
    memory : Memory
    jobs : JobProgress, optional
        Of a job list.

    Attributes
    ----------
    how : str
        `SEARCHED` or `DRIVEN`.
    lore : Lore
        Knowledge of the first agent, which memory stores.
    watch : Watcher, optional
        Called after memory has stored a task.
    """

    how: str
    lore: Lore

    def __init__(
        self,
        settings: LifeSettings,
        place: Place,
        places: OwnPlaces,
        memory: Memory,
        jobs: JobProgress | None = None,
    ) -> None:
        self.settings, self.place, self.places, self.memory, self.jobs = settings, place, places, memory, jobs
        self.watch: Watcher | None = None
        self.finished: list[dict] = []
        self.results: list[dict[str, Result]] = []
        self._tasks_before = memory.tasks(settings.memory.robot)
        self._unstored: list[Record] = place.news

    @abstractmethod
    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""

    @abstractmethod
    def live_by_all(self, number: int, seq: int, own: OwnGoal | None, stop: Event) -> LivedByAll:
        """Live task `number`, which is number `seq` of this run; the goal is drawn without an `own` one."""

    @abstractmethod
    def summary(self) -> dict:
        """The key ``summary`` of the report, with at least one finished task."""

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task with each agent."""
        own = self.places.goal(seq)
        lived = self.live_by_all(number, seq, own, stop)
        world = self.place.world
        about = {"index": number, "goal": world.cells[lived.goal].tolist(), "how": self.how}
        about |= ({} if own is None else own.to_dict()) | dict(lived.report)
        agents = {name: result.to_dict() for name, result in lived.results.items()}
        records = [*lived.records, *self._unstored, *([] if own is None else own.names)]
        if self.jobs is not None:
            records.append(self.jobs.record(seq + 1))
        return LivedTask(
            [record for record in records if len(record.slots)],
            about | {"world": world.fingerprint, "agents": agents, **lived.document},
            (about | {"agents": agents}, dict(lived.results)),
        )

    def finish(self, lived: LivedTask) -> None:
        """Report a task; keep the policies of the last tasks alone."""
        task, results = lived.result
        self._unstored = []
        self.finished.append(task)
        self.results.append(results)
        if self.watch:
            self.watch(task, results)
        if len(self.results) > TASKS_WITH_POLICY:
            for old in self.results[-1 - TASKS_WITH_POLICY].values():
                old.drop_arrays()

    def report(self, seconds: float) -> dict:
        """The JSON document of ``lifelore live``."""
        settings, world, robot = self.settings, self.place.world, self.settings.memory.robot
        document = settings_document(settings, world, self.memory.location)
        return {
            "domain": settings.world.domain,
            "how": self.how,
            "map": document["map"],
            "n_states": world.n_states,
            "building": self.place.report,
            "seed": settings.seed,
            "settings": document,
            "tasks": self.finished,
            "summary": self.summary() if self.finished else {},
            "memory": {"tasks_before": self._tasks_before, "tasks_after": self.memory.tasks(robot)},
            "seconds": round(seconds, 3),
        }
