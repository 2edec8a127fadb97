"""`live`: an agent lives through a stream of tasks and uses what it learnt in the earlier ones."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from threading import Event
from typing import Any

from lifelore.agent.life.loop import run_life
from lifelore.agent.live.baselines import AGENTS, agents_for
from lifelore.agent.live.buildings.recognition import Place, own_place, recognised_place
from lifelore.agent.live.driven.driven_life import DrivenLife
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.live.goals.job_progress import JobProgress
from lifelore.agent.live.goals.own_places import own_places
from lifelore.agent.live.grid_life import DRIVEN, Result, Watcher
from lifelore.agent.live.life_settings import LifeSettings, life_settings
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.output.known_building import KnownBuilding
from lifelore.agent.live.searched_life import SearchedLife
from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import map_from_settings, world_from_settings
from lifelore.memory import Memory, open_memory

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


def live(
    settings: LifeSettings | None = None,
    *,
    progress: Progress | None = None,
    stop: Event | None = None,
    watch: Watcher | None = None,
    notify: Callable[[str], None] | None = None,
    **keys: Any,
) -> Life:
    """Live through tasks in one world and store what is learnt in memory.

    Parameters
    ----------
    settings : LifeSettings, optional
        All settings, in place of `keys`.
    progress : callable, optional
        Called as ``progress(done, total, label)`` before the first task and after each task.
    stop : threading.Event, optional
        Set it to stop early: the task in progress is dropped, the finished tasks stay.
    watch : callable, optional
        Called as ``watch(task, results)`` after memory has stored a task: the report's entry, and the results by
        agent.
    notify : callable, optional
        Called with a line of text for a person, for instance if ``scratch`` is left out of a big world.
    **keys
        Settings by key: those of ``lifelore live --settings``, and ``map``, ``tasks``, ``goal``,
        ``goals`` (a job list's path), ``agent``, ``robot``, ``memory`` and ``seed``. A point is a pair of metres.

    Returns
    -------
    Life
        Its ``report`` is the JSON document of ``lifelore live``.

    Raises
    ------
    InputError, NotFoundError
        A key is unknown, or a setting or the map breaks its rule.
    StoreError
        Memory cannot store a task; earlier tasks stay stored.

    Examples
    --------
    >>> life = live(map="depot.yaml", tasks=30, memory="depot.db")  # doctest: +SKIP
    """
    if settings is not None and keys:
        raise InputError(f"settings holds all settings, got also {', '.join(keys)}; give one of the two")
    settings = settings or life_settings(keys)
    stop, notify = stop or Event(), notify or (lambda line: None)
    began = time.perf_counter()
    first = agents_for(settings.agent)[0]  # a mistake in the name shows before the map is read
    occupancy = map_from_settings(settings.world) if settings.world.domain == "building" else None
    world = world_from_settings(settings.world, occupancy)
    with open_memory(settings.memory.location) as memory:
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
        kind = DrivenLife if settings.driven else partial(SearchedLife, notify=notify)
        life = kind(settings, place, own_places(settings, place, memory), memory, jobs)
        life.watch = watch
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
            building = KnownBuilding.recalled(place, occupancy, memory, life.lore.model)
    return Life(report, place.world, life.results, life.lore, stop.is_set(), life.places.start, building)


def _place(
    settings: LifeSettings, world: GridWorld, occupancy: OccupancyMap | None, memory: Memory, agent: str
) -> Place:
    """The remembered building of the world, if the agent remembers transitions of buildings."""
    name = settings.memory.building
    if occupancy is not None and (settings.driven or AGENTS[agent].remembers):
        return recognised_place(settings.world, world, occupancy, memory, name)
    if name is not None:
        raise InputError(
            f"building names a map that is remembered, got {name!r} for a life that remembers no map; leave it out"
        )
    return own_place(world, occupancy)
