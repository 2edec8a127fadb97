"""`live`: an agent lives through a stream of tasks and uses what it learnt in the earlier ones."""

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from threading import Event

from lifelore.agent.life.loop import LivedTask, run_life
from lifelore.agent.live import baselines
from lifelore.agent.live.baselines import agent_kind, agents_for
from lifelore.agent.live.buildings.map_watch import MapWatch
from lifelore.agent.live.buildings.recognition import Place, own_place, recognised_place
from lifelore.agent.live.driven.driven_tasks import DrivenTasks
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.live.goals.job_progress import JobProgress
from lifelore.agent.live.goals.own_places import own_places
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
    first_here : int
        Number of tasks that were lived before the map was last replaced (`LifeSettings.watch`).
    building : KnownBuilding, optional
        What is known of the building at the end.
    """

    report: dict
    world: GridWorld
    results: list[dict[str, Result]] = field(repr=False)
    lore: Lore = field(repr=False)
    stopped: bool = False
    start: int | None = None
    first_here: int = 0
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
        Called with a line of text: before the first task if `scratch` is left out of a big world, and when a
        watched map was replaced or cannot be used.

    Raises
    ------
    InputError, NotFoundError
        A setting or the map breaks its rule.
    StoreError
        Memory cannot store the task; earlier tasks stay stored.
    """
    stop, notify = stop or Event(), notify or (lambda line: None)
    began = time.perf_counter()
    first = agents_for(settings.agent, settings.learner)[0]  # a mistake in the name shows before the map is read
    map_watch = MapWatch(settings.world) if settings.watch else None
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
        tasks: TasksOfLife
        if settings.driven:
            tasks = DrivenTasks(settings, memory, jobs)
        else:
            tasks = SearchedTasks(settings, _names(settings, place.world.n_states, notify), memory, pool)
        life = _GridLife(settings, tasks, memory, map_watch, jobs, watch, notify)
        life.settle(place, occupancy, 0)
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
        if life.given is not None:
            building = KnownBuilding.recalled(life.place, life.given, memory, tasks.lore.model)
    return Life(
        report,
        life.place.world,
        life.results,
        tasks.lore,
        stop.is_set(),
        start=life.places.start,
        first_here=life.first_here,
        building=building,
    )


def _names(settings: LifeSettings, places: int, notify: Callable[[str], None]) -> list[str]:
    """Names of the agents that live; in a big world, `scratch` lives beside the others only if it is asked for."""
    small = places <= baselines.BIG
    names = agents_for(settings.agent, settings.learner, small if settings.compare is None else settings.compare)
    if settings.compare is None and names != agents_for(settings.agent, settings.learner):
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
    tasks: TasksOfLife
    memory: Memory
    map_watch: MapWatch | None
    jobs: JobProgress | None
    watch: Watcher | None
    notify: Callable[[str], None]
    unstored: list[Record] = field(default_factory=list)
    finished: list[dict] = field(default_factory=list)
    results: list[dict[str, Result]] = field(default_factory=list)
    map_changes: list[dict] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.tasks_before = self.memory.tasks(self.settings.memory.robot)

    def settle(self, place: Place, given: OccupancyMap | None, first: int) -> None:
        """Live at `place` from task number `first` on; changes nothing if a goal is not free there."""
        places = own_places(self.settings, place, self.memory, first)
        self.tasks.settle(place, places)
        self.place, self.given, self.first_here, self.places = place, given, first, places
        self.unstored = self.unstored + place.news

    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""
        self.tasks.recall()

    def _look_at_map(self, map_watch: MapWatch, index: int, done: int) -> None:
        """Replace the world if the watched map has changed; keep it if the new map cannot be used."""
        change: dict = {"before_task": index}
        line = f"map {self.settings.world.map} changed before task {index}"
        try:
            given = map_watch.changed()
            if given is None:
                return
            world = world_from_settings(self.settings.world, given)
            self.settle(_place(self.settings, world, given, self.memory, self.tasks.names[0]), given, done)
            # All agents move to the new map, and still know what agrees with it.
            agreement, n_states = self.tasks.carry(), self.place.world.n_states
            change |= {"used": True, "n_states": n_states, "agreement": round(agreement, 4)}
            line += f": {n_states:,} places, {int(100 * agreement)} % of the remembered ones agree"
        except InputError as error:
            change |= {"used": False, "reason": str(error)}
            line += f", but cannot be used: {error}; the last good map stays"
        self.map_changes.append(change)
        self.notify(line)

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task with each agent; look at the watched map before."""
        if self.map_watch and seq:
            self._look_at_map(self.map_watch, number, seq)
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
        report = {
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
        return report | ({"map_changes": self.map_changes} if settings.watch else {})
