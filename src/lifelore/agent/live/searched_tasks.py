"""The tasks of a life whose goals are hidden: each agent searches, guided by what it learnt before."""

from concurrent.futures import Executor
from threading import Event

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.baselines import agent_kind
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.goals.own_places import OwnGoal, OwnPlaces
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lived_tasks import SEARCHED, LivedByAll
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.agent.live.summary import summarise
from lifelore.agent.live.task_result import TaskResult
from lifelore.agent.live.task_search import SightLists, TaskSearch
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import mean_start_value, optimal_q
from lifelore.core.protocols import Record
from lifelore.core.streams import stream
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.visibility import visible_places
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.memory import Memory


class SearchedTasks:
    """Tasks with hidden goals, and what each agent knows; see `TasksOfLife`.

    Parameters
    ----------
    settings : LifeSettings
    place : Place
    places : OwnPlaces
    memory : Memory
    names : list of str
        Agents that live the same tasks.
    pool : Executor
        Runs the agents side by side.
    """

    how = SEARCHED

    def __init__(
        self,
        settings: LifeSettings,
        place: Place,
        places: OwnPlaces,
        memory: Memory,
        names: list[str],
        pool: Executor,
    ) -> None:
        self.names = names
        self._kinds = {name: agent_kind(name, settings) for name in names}
        self._settings, self._place, self._memory, self._pool = settings, place, memory, pool
        self._lores: dict[str, Lore] = {}
        self._goals = hidden_goals(place.world, settings, place.grid.frame, places.start)
        self._starts = None if places.start is None else np.array([places.start], np.int32)
        self._sight = None if settings.sensor.reach is None else _sight_lists(place, settings.sensor.reach)

    @property
    def lore(self) -> Lore:
        """Knowledge of the first agent."""
        return self._lores[self.names[0]]

    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""
        settings, place = self._settings, self._place
        scope = prior_scope(place.world, settings.prior)
        first = Lore.recalled(place.world, scope, settings.alpha0, self._memory, place.grid)
        self._lores = self._lores or {name: first.copy() for name in self.names}
        self._lores[self.names[0]] = first

    def live(self, number: int, seq: int, own: OwnGoal | None, stop: Event) -> LivedByAll:
        """Live a task with each agent; they learn on the same random streams."""
        settings, world = self._settings, self._place.world
        goal = int(stream(settings.seed, "task", number, "goal").choice(self._goals)) if own is None else own.state
        task = world.task(goal, self._starts)
        tables = task.tables()
        optimal = mean_start_value(tables, optimal_q(tables, task.domain.discount).max(axis=1))
        if optimal <= 0:
            raise InputError(
                f"discount must leave the goal of task {number} a positive value at its starts, "
                f"got {task.domain.discount}; use a larger discount"
            )
        search = TaskSearch(settings, world, self._sight, number, task, tables, optimal, stop)
        try:
            futures = {
                name: self._pool.submit(search.live, self._kinds[name], self._lores[name]) for name in self.names
            }
            results = {name: future.result() for name, future in futures.items()}
        except BaseException:
            stop.set()
            raise
        records = {name: self._learn(name, results[name], goal) for name in self.names}
        first = self.names[0]
        known = {"places": self.lore.known_places} if self._kinds[first].remembers else {}
        return LivedByAll(goal, results, records[first], {"optimal_return": optimal}, known)

    def _learn(self, name: str, result: TaskResult, goal: int) -> list[Record]:
        """Add a finished task to the knowledge of one agent; return the records that memory is to store."""
        kind, lore, records = self._kinds[name], self._lores[name], []
        if kind.uses_prior:
            records.append(lore.learn_prior(result.best, goal, self._settings.weight))
        if kind.remembers:
            records.append(lore.model_news())
            if self._settings.destinations and result.reached:
                records.append(lore.goals.found(goal))
        return [record for record in records if len(record.slots)]

    def summary(self, tasks: list[dict]) -> dict:
        """Means of each agent over thirds of the tasks, and ratios to `scratch`."""
        return summarise(tasks)


def hidden_goals(
    world: GridWorld, settings: LifeSettings, frame: str, start: int | None = None
) -> NDArray[np.int64]:
    """States among which goals are drawn, never the `start` of every episode; `frame` is the key of their grid."""
    places = np.delete(np.arange(world.n_states), [] if start is None else start)
    if settings.destinations > len(places):
        raise InputError(
            f"destinations must be at most the {len(places)} free places of this world, "
            f"got {settings.destinations}; use fewer"
        )
    if not settings.destinations:
        return places
    # Drawn from all cells of the frame, so that a map with small changes has the same destinations.
    states = stream(settings.seed, "destinations", frame).permutation(world.state_of.ravel())
    return states[np.isin(states, places)][: settings.destinations]


def _sight_lists(place: Place, reach: float) -> SightLists:
    """The places in sight of each place of a building, up to `reach` metres."""
    assert place.occupancy is not None, "settings give a lidar in buildings alone"
    visible = visible_places(floor_of(place.occupancy, place.world), place.world, reach)
    return visible.indptr.astype(np.int64), visible.indices.astype(np.int32)
