"""`live`: an agent lives through a stream of tasks and uses what it learnt in the earlier ones."""

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from threading import Event

from lifelore.agent.life.loop import LivedTask, run_life
from lifelore.agent.live import baselines
from lifelore.agent.live.baselines import agent_kind, agents_for
from lifelore.agent.live.buildings.recognition import Place, own_place, recognised_place
from lifelore.agent.live.driven.driven_tasks import DrivenTasks
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.live.goals.job_progress import JobProgress
from lifelore.agent.live.goals.own_places import OwnPlaces, own_places
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lived_tasks import DRIVEN, Result, TasksOfLife
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.output.known_building import KnownBuilding
from lifelore.agent.live.searched_tasks import SearchedTasks
from lifelore.agent.live.settings_document import settings_document
from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress, Record
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import map_from_settings, world_from_settings
from lifelore.memory import Memory, open_memory

TASKS_WITH_POLICY = 4
"""Last tasks whose policies stay in main memory for the pictures; more cost an array of the world's size each."""

_KNOWN_GOALS = "destinations draws hidden goals alone; these goals are known, and driven to"


@dataclass
class Life:
    """A finished (or stopped) life: the report, and the data for the pictures.

    report : dict
        The JSON document of ``lifelore live``.
    world : GridWorld
    results : list of dict
        For each task: agent name to `TaskResult`, or `DrivenJob` where the goal is known; policies and states
        passed only in the last `TASKS_WITH_POLICY`.
    lore : Lore
        Knowledge of the first agent at the end.
    stopped : bool
        Whether the user asked to stop; the report covers the tasks finished before.
    start : int, optional
        State in which every episode started, if it was given.
    building : KnownBuilding, optional
        What is known of the building at the end.
    """

    report: dict
    world: GridWorld
    results: list[dict[str, Result]] = field(repr=False)
    lore: Lore = field(repr=False)
    stopped: bool = False
    start: int | None = None
    building: KnownBuilding | None = field(default=None, repr=False)

    @property
    def driven(self) -> bool:
        """Whether the goals were known, and driven to."""
        return self.report["how"] == DRIVEN

    @property
    def floor(self) -> Floor | None:
        """The building at the resolution of its map; None in worlds without a map."""
        return None if self.building is None else self.building.floor


Watcher = Callable[[dict, dict[str, Result]], None]
"""Called with the report's entry of a finished task, and with the result of each agent."""


def live(
    settings: LifeSettings,
    *,
    progress: Progress | None = None,
    stop: Event | None = None,
    watch: Watcher | None = None,
    notify: Callable[[str], None] | None = None,
) -> Life:
    """Live through ``settings.n_tasks`` tasks and store what is learnt in memory.

    Parameters
    ----------
    settings : LifeSettings
    progress : callable, optional
        Called as ``progress(done, total, label)`` before the first task and after each task.
    stop : threading.Event, optional
        Set it to stop early: the task in progress is dropped, the finished tasks stay.
    watch : callable, optional
        Called as ``watch(task, results)`` after memory has stored a task; see `Watcher`.
    notify : callable, optional
        Called with a line of text before the first task, for instance if `scratch` is left out of a big world.

    Raises
    ------
    InputError, NotFoundError
        A setting or the map breaks its rule.
    StoreError
        Memory cannot store the task; earlier tasks stay stored.
    """
    stop, notify = stop or Event(), notify or (lambda line: None)
    began = time.perf_counter()
    first = agents_for(settings.agent)[0]  # a mistake in the name shows before the map is read
    occupancy = map_from_settings(settings.world) if settings.world.domain == "building" else None
    world = world_from_settings(settings.world, occupancy)
    with open_memory(settings.memory.location) as memory, ThreadPoolExecutor(settings.jobs) as pool:
        place = _place(settings, world, occupancy, memory, first)
        if settings.driven and settings.destinations:
            notify(_KNOWN_GOALS)
        jobs = None
        if settings.goals:
            key, again = NamedPlaces.of(place).key, settings.again
            jobs = JobProgress.recalled(settings.goals, settings.memory.robot, key, memory, again)
        if jobs and jobs.finished:
            settings = replace(settings, goals=jobs.unfinished(settings.goals))
            notify(jobs.notice())
        names = [] if settings.driven else _names(settings, place.world.n_states, notify)
        places = own_places(settings, place, memory)
        tasks: TasksOfLife
        if settings.driven:
            tasks = DrivenTasks(settings, place, places, memory, jobs)
        else:
            tasks = SearchedTasks(settings, place, places, memory, names, pool)
        life = _GridLife(settings, place, places, tasks, memory, jobs, watch)
        run_life(
            life,
            settings.n_tasks,
            memory=memory,
            robot=settings.memory.robot,
            refresh=settings.memory.refresh,
            progress=progress,
            stop=stop,
            notify=notify,
        )
        report = life.report(time.perf_counter() - began)
        building = None
        if occupancy is not None:
            building = KnownBuilding.recalled(place, occupancy, memory, tasks.lore.model)
    return Life(
        report, place.world, life.results, tasks.lore, stop.is_set(), start=places.start, building=building
    )


def _names(settings: LifeSettings, places: int, notify: Callable[[str], None]) -> list[str]:
    """Names of the agents that live; in a big world, `scratch` lives beside the others only if it is asked for."""
    small = places <= baselines.BIG
    names = agents_for(settings.agent, small if settings.compare is None else settings.compare)
    if settings.compare is None and names != agents_for(settings.agent):
        building = settings.world.domain == "building"
        smaller = "a larger cell (--set cell=METRES)" if building else "a smaller size (--set size=CELLS)"
        notify(
            f"{places:,} places: above {baselines.BIG:,} places scratch lives beside {settings.agent} only with "
            f"--set compare=true; {smaller} takes less time"
        )
    return names


def _place(
    settings: LifeSettings, world: GridWorld, occupancy: OccupancyMap | None, memory: Memory, agent: str
) -> Place:
    """The remembered building of the world, if the agent remembers transitions of buildings."""
    name = settings.memory.building
    if occupancy is not None and (settings.driven or agent_kind(agent, settings).remembers):
        return recognised_place(settings.world, world, occupancy, memory, name)
    if name is not None:
        raise InputError(
            f"building names a map that is remembered, got {name!r} for a life that remembers no map; leave it out"
        )
    return own_place(world, occupancy)


@dataclass
class _GridLife:
    """A life in progress: where it is lived, its tasks, and what memory stores of them; a `RunningLife`."""

    settings: LifeSettings
    place: Place
    places: OwnPlaces
    tasks: TasksOfLife
    memory: Memory
    jobs: JobProgress | None
    watch: Watcher | None
    finished: list[dict] = field(default_factory=list)
    results: list[dict[str, Result]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.tasks_before = self.memory.tasks(self.settings.memory.robot)
        self.unstored: list[Record] = self.place.news

    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""
        self.tasks.recall()

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task with each agent."""
        own = self.places.goal(seq)
        lived = self.tasks.live(number, seq, own, stop)
        world = self.place.world
        about = {"index": number, "goal": world.cells[lived.goal].tolist(), "how": self.tasks.how}
        about |= ({} if own is None else own.to_dict()) | dict(lived.report)
        agents = {name: result.to_dict() for name, result in lived.results.items()}
        records = [*lived.records, *self.unstored, *([] if own is None else own.names)]
        if self.jobs is not None:
            records.append(self.jobs.record(seq + 1))
        return LivedTask(
            records,
            about | {"world": world.fingerprint, "agents": agents, **lived.document},
            (about | {"agents": agents}, lived.results),
        )

    def finish(self, lived: LivedTask) -> None:
        """Report a task; keep the policies of the last tasks alone."""
        task, results = lived.result
        self.unstored = []
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
            "how": self.tasks.how,
            "map": document["map"],
            "n_states": world.n_states,
            "building": self.place.report,
            "seed": settings.seed,
            "settings": document,
            "tasks": self.finished,
            "summary": self.tasks.summary(self.finished) if self.finished else {},
            "memory": {"tasks_before": self.tasks_before, "tasks_after": self.memory.tasks(robot)},
            "seconds": round(seconds, 3),
        }
