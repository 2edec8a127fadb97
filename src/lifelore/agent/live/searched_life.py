"""A life whose goals are hidden: each agent searches, guided by what it learnt before."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live import baselines
from lifelore.agent.live.baselines import AGENTS, agents_for
from lifelore.agent.live.goals.own_places import OwnGoal
from lifelore.agent.live.grid_life import SEARCHED, GridLife, LivedByAll
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.summary import summarise
from lifelore.agent.live.task_result import TaskResult
from lifelore.agent.live.task_search import TaskSearch
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import mean_start_value, optimal_q
from lifelore.core.protocols import Record
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld


class SearchedLife(GridLife):
    """A life of tasks with hidden goals. Parameters as of `GridLife`, and ``notify``, see `live`."""

    how = SEARCHED

    def __init__(self, *life: Any, notify: Callable[[str], None]) -> None:
        super().__init__(*life)
        settings, place, start = self.settings, self.place, self.places.start
        self._kinds = {name: AGENTS[name] for name in _names(settings, place.world, notify)}
        self._first = next(iter(self._kinds))
        self._lores: dict[str, Lore] = {}
        self._goals = hidden_goals(place.world, settings, place.grid.frame, start)
        self._starts = None if start is None else np.array([start], np.int32)

    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""
        settings, place = self.settings, self.place
        self.lore = Lore.recalled(place.world, settings.alpha0, self.memory, place.grid)
        self._lores = self._lores or {name: self.lore.copy() for name in self._kinds}
        self._lores[self._first] = self.lore

    def live_by_all(self, number: int, seq: int, own: OwnGoal | None, stop: Event) -> LivedByAll:
        """Live a task with each agent; they learn on the same random streams."""
        settings, world = self.settings, self.place.world
        goal = int(stream(settings.seed, "task", number, "goal").choice(self._goals)) if own is None else own.state
        task = world.task(goal, self._starts)
        tables = task.tables()
        optimal = mean_start_value(tables, optimal_q(tables, task.domain.discount).max(axis=1))
        if optimal <= 0:
            raise InputError(
                f"discount must leave the goal of task {number} a positive value at its starts, "
                f"got {task.domain.discount}; use a larger discount"
            )
        search = TaskSearch(settings, world, number, task, tables, optimal, stop)
        with ThreadPoolExecutor(settings.jobs) as pool:
            try:
                futures = {
                    name: pool.submit(search.live, self._kinds[name], self._lores[name]) for name in self._kinds
                }
                results = {name: future.result() for name, future in futures.items()}
            except BaseException:
                stop.set()
                raise
        records = {name: self._learn(name, results[name], goal) for name in self._kinds}
        known = {"places": self.lore.known_places} if self._kinds[self._first].remembers else {}
        return LivedByAll(goal, results, records[self._first], {"optimal_return": optimal}, known)

    def _learn(self, name: str, result: TaskResult, goal: int) -> list[Record]:
        """Add a finished task to the knowledge of one agent; return the records that memory is to store."""
        kind, lore, records = self._kinds[name], self._lores[name], []
        if kind.uses_prior:
            records.append(lore.learn_prior(result.best, goal, self.settings.weight))
        if kind.remembers:
            records.append(lore.model_news())
            if self.settings.destinations and result.reached:
                records.append(lore.goals.found(goal))
        return records

    def summary(self) -> dict:
        """Means of each agent over thirds of the tasks, and ratios to `scratch`."""
        return summarise(self.finished)


def _names(settings: LifeSettings, world: GridWorld, notify: Callable[[str], None]) -> list[str]:
    """Names of the agents that live; in a big world, `scratch` lives beside the others only if it is asked for."""
    small = world.n_states <= baselines.BIG
    names = agents_for(settings.agent, small if settings.compare is None else settings.compare)
    if settings.compare is None and names != agents_for(settings.agent):
        building = settings.world.domain == "building"
        smaller = "a larger cell (--set cell=METRES)" if building else "a smaller size (--set size=CELLS)"
        notify(
            f"{world.n_states:,} places: above {baselines.BIG:,} places scratch lives beside {settings.agent} "
            f"only with --set compare=true; {smaller} takes less time"
        )
    return names


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
