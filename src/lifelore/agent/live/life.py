"""`live`: an agent lives through a stream of tasks and uses what it learnt in the earlier ones."""

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from threading import Event

from lifelore.agent.life.loop import LivedTask, run_life
from lifelore.agent.live.baselines import AGENTS, agents_for
from lifelore.agent.live.buildings.carried_model import carried_model
from lifelore.agent.live.buildings.map_watch import MapWatch
from lifelore.agent.live.buildings.recognition import Place, own_place, recognised_place
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.live.goals.job_progress import JobProgress
from lifelore.agent.live.goals.own_places import OwnGoal, own_places
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.life_size import size_of_life
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.agent.live.output.known_building import KnownBuilding
from lifelore.agent.live.settings_document import path_text, settings_document
from lifelore.agent.live.shared_task import SharedTask
from lifelore.agent.live.sight import sight_lists
from lifelore.agent.live.summary import summarise
from lifelore.agent.live.task_result import TaskResult
from lifelore.agent.live.task_stream import TaskStream
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import mean_start_value, optimal_q
from lifelore.core.protocols import Progress, Record
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import map_from_settings, world_from_settings
from lifelore.memory import Memory, open_memory

TASKS_WITH_POLICY = 4
"""Last tasks whose policies stay in main memory for the pictures; more cost an array of the world's size each."""


@dataclass
class Life:
    """A finished (or stopped) life: the report, and the data for the pictures.

    report : dict
        The JSON document of ``lifelore live``.
    world : GridWorld
    results : list of dict
        For each task: agent name to `TaskResult`; policies only in the last `TASKS_WITH_POLICY`.
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
    results: list[dict[str, TaskResult]] = field(repr=False)
    lore: Lore = field(repr=False)
    stopped: bool = False
    start: int | None = None
    first_here: int = 0
    building: KnownBuilding | None = field(default=None, repr=False)

    @property
    def floor(self) -> Floor | None:
        """The building at the resolution of its map; None in worlds without a map."""
        return None if self.building is None else self.building.floor


Watcher = Callable[[dict, dict[str, TaskResult]], None]
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
        Called with a line of text: before the first task if the world is big, and when a watched map was replaced
        or cannot be used.

    Raises
    ------
    InputError, NotFoundError
        A setting or the map breaks its rule.
    StoreError
        Memory cannot store the task; earlier tasks stay stored.
    """
    stop = stop or Event()
    began = time.perf_counter()
    agents_for(settings.agent, settings.learner)  # a mistake in the name shows before the map is read
    map_watch = MapWatch(settings.world) if settings.watch else None
    occupancy = map_from_settings(settings.world) if settings.world.domain == "building" else None
    world = world_from_settings(settings.world, occupancy)
    with open_memory(settings.memory.location) as memory:
        first = agents_for(settings.agent, settings.learner)[0]
        place = _place(settings, world, occupancy, memory, first)
        names, notice = size_of_life(settings, place.world.n_states)
        if notify and notice:
            notify(notice)
        jobs = _job_progress(settings, place, memory)
        if jobs and jobs.finished:
            settings = replace(settings, goals=jobs.unfinished(settings.goals))
            if notify:
                notify(jobs.notice())
        with ThreadPoolExecutor(settings.jobs) as pool:
            life = _GridLife(settings, place, occupancy, names, memory, pool, map_watch, jobs, watch, notify)
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
        report = _report(settings, life, time.perf_counter() - began)
        building = None
        if life.given is not None:
            building = KnownBuilding.recalled(life.place, life.given, memory, life.lores[names[0]].model)
    return Life(
        report,
        life.world,
        life.results,
        life.lores[names[0]],
        stop.is_set(),
        start=life.places.start,
        first_here=life.first_here,
        building=building,
    )


def _place(
    settings: LifeSettings, world: GridWorld, occupancy: OccupancyMap | None, memory: Memory, agent: str
) -> Place:
    """The remembered building of the world, if the agent remembers transitions of buildings."""
    name, remembers = settings.memory.building, AGENTS[agent].remembers and settings.learner == "model"
    if occupancy is not None and remembers:
        return recognised_place(settings.world, world, occupancy, memory, name)
    if name is not None:
        raise InputError(
            f"building names a map that is remembered, got {name!r} for a life that remembers no map; leave it out"
        )
    return own_place(world, occupancy)


def _floor_at(place: Place) -> Floor:
    assert place.occupancy is not None, "a building has a map"
    return floor_of(place.occupancy, place.world)


def _job_progress(settings: LifeSettings, place: Place, memory: Memory) -> JobProgress | None:
    if not settings.goals:
        return None
    progress = JobProgress.recalled(settings.goals, settings.memory.robot, NamedPlaces.of(place).key, memory)
    return replace(progress, finished=0) if settings.again else progress


class _GridLife:
    """A life in progress: the knowledge of each agent, and the memory that stores the first one's."""

    def __init__(
        self,
        settings: LifeSettings,
        place: Place,
        given: OccupancyMap | None,
        names: list[str],
        memory: Memory,
        pool: ThreadPoolExecutor,
        map_watch: MapWatch | None,
        jobs: JobProgress | None,
        watch: Watcher | None,
        notify: Callable[[str], None] | None,
    ) -> None:
        self.settings, self.names, self.memory, self.pool = settings, names, memory, pool
        self.map_watch, self.jobs, self.watch, self.notify = map_watch, jobs, watch, notify
        self.unstored: list[Record] = []
        self._settle(place, given, first=0)
        self.lores: dict[str, Lore] = {}
        self.tasks_before = memory.tasks(settings.memory.robot)
        self.finished: list[dict] = []
        self.results: list[dict[str, TaskResult]] = []
        self.map_changes: list[dict] = []

    def _settle(self, place: Place, given: OccupancyMap | None, first: int) -> None:
        """Live at `place` from task number `first` on; changes nothing if a goal is not free there."""
        names = NamedPlaces.of(place)
        places = own_places(self.settings, place.world, lambda: _floor_at(place), names, self.memory, first)
        stream = TaskStream(place.world, self.settings, place.grid.frame, places.start)
        self.sight = sight_lists(self.settings.sensor, place)
        self.world, self.place, self.given, self.first_here = place.world, place, given, first
        self.named, self.places, self.stream = names, places, stream
        self.scope = prior_scope(place.world, self.settings.prior.condition)
        self.unstored = self.unstored + place.news

    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""
        first = self._recalled()
        self.lores = self.lores or {name: first.copy() for name in self.names}
        self.lores[self.names[0]] = first

    def _recalled(self) -> Lore:
        return Lore.recalled(self.world, self.scope, self.settings.prior.alpha0, self.memory, self.place.grid)

    def _look_at_map(self, index: int, done: int) -> None:
        """Replace the world if the watched map has changed; keep it if the new map cannot be used."""
        path = self.settings.world.map
        change: dict = {"before_task": index}
        assert self.map_watch is not None, "only a watched map is looked at"
        try:
            given = self.map_watch.changed()
            if given is None:
                return
            change |= self._replace_map(given, done)
            line = (
                f"map {path} changed before task {index}: {self.world.n_states:,} places, "
                f"{int(100 * change['agreement'])} % of the remembered ones agree"
            )
        except InputError as error:
            change |= {"used": False, "reason": str(error)}
            line = f"map {path} changed before task {index}, but cannot be used: {error}; the last good map stays"
        self.map_changes.append(change)
        if self.notify:
            self.notify(line)

    def _replace_map(self, given: OccupancyMap, done: int) -> dict:
        """Move all agents to the new map; what agrees with it, they still know."""
        world = world_from_settings(self.settings.world, given)
        place = _place(self.settings, world, given, self.memory, self.names[0])
        old_scope = self.scope
        self._settle(place, given, done)
        first, lores, agreement = self._recalled(), {}, 0.0
        for i, name in enumerate(self.names):
            lore, old = first.copy() if i else first, self.lores[name]
            lore.model, share = carried_model(old, place, self.memory)
            if i and self.scope.key == old_scope.key:
                lore.prior = old.prior
            if not i:
                agreement = share
            lores[name] = lore
        self.lores = lores
        return {"used": True, "n_states": world.n_states, "agreement": round(agreement, 4)}

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task with each agent; look at the watched map before."""
        if self.map_watch and seq:
            self._look_at_map(number, seq)
        own = self.places.goal(seq)
        task = self.stream.task(number, own and own.state)
        tables = task.tables()
        optimal = mean_start_value(tables, optimal_q(tables, task.domain.discount).max(axis=1))
        if optimal <= 0:
            raise InputError(
                f"discount must leave the goal of task {number} a positive value at its starts, "
                f"got {task.domain.discount}; use a larger discount"
            )
        shared = SharedTask(
            self.settings, self.world, self.sight, self.stream, task, tables, optimal, number, stop
        )
        try:
            futures = {name: self.pool.submit(shared.live, AGENTS[name], self.lores[name]) for name in self.names}
            results = {name: future.result() for name, future in futures.items()}
        except BaseException:
            stop.set()
            raise
        goal = int(task.goal)  # type: ignore[arg-type]
        records = {name: self._learn(name, results[name], goal) for name in self.names}
        chosen = {} if own is None else own.to_dict()
        about = {"index": number, "goal": self.world.cells[goal].tolist()}
        agents = {name: result.to_dict() for name, result in results.items()}
        return LivedTask(
            records[self.names[0]] + self.unstored + self._names(own) + self._job_records(seq),
            about | chosen | {"world": self.world.fingerprint, "agents": agents, **self._known()},
            (about | chosen | {"optimal_return": optimal, "agents": agents}, results),
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

    def _known(self) -> dict[str, int]:
        """Number of places that the first agent knows, if it remembers any."""
        name = self.names[0]
        if not AGENTS[name].remembers or self.settings.learner != "model":
            return {}
        return {"places": int((self.lores[name].model.percept >= 0).sum())}

    def _names(self, own: OwnGoal | None) -> list[Record]:
        """The record by which memory knows a named destination from now on."""
        end = own and own.destination
        if end is None or end.name is None or end.point is None:
            return []
        return [self.named.record(end.name, end.point)]

    def _job_records(self, seq: int) -> list[Record]:
        """The record by which memory knows that the job of task number `seq` is finished."""
        return [] if self.jobs is None else [self.jobs.record(seq + 1)]

    def _learn(self, name: str, result: TaskResult, goal: int) -> list[Record]:
        """Add a finished task to the knowledge of one agent; return the records that memory is to store."""
        kind, lore, records = AGENTS[name], self.lores[name], []
        if kind.uses_prior and self.settings.prior.condition != "none":
            records.append(lore.learn_prior(result.best, goal, self.settings.prior.weight))
        if kind.remembers and self.settings.learner == "model":
            records.append(lore.model_news())
            if self.settings.destinations and result.reached:
                records.append(lore.goals.found(goal))
        return [record for record in records if len(record.slots)]


def _report(settings: LifeSettings, life: _GridLife, seconds: float) -> dict:
    world, place = life.world, life.place
    report = {
        "domain": settings.world.domain,
        "map": path_text(settings.world.map),
        "n_states": world.n_states,
        "building": place.report,
        "seed": settings.seed,
        "settings": settings_document(settings, world, life.memory.location),
        "tasks": life.finished,
        "summary": summarise(life.finished) if life.finished else {},
        "memory": {"tasks_before": life.tasks_before, "tasks_after": life.memory.tasks(settings.memory.robot)},
        "seconds": round(seconds, 3),
    }
    return report | ({"map_changes": life.map_changes} if settings.watch else {})
