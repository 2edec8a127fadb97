"""The tasks of a life whose goals are hidden: each agent searches, guided by what it learnt before."""

from concurrent.futures import Executor
from threading import Event

from lifelore.agent.live.baselines import AGENTS
from lifelore.agent.live.buildings.carried_model import carried_model
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.goals.own_places import OwnGoal, OwnPlaces
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lived_tasks import SEARCHED, LivedByAll
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.agent.live.shared_task import SharedTask
from lifelore.agent.live.sight import sight_lists
from lifelore.agent.live.summary import summarise
from lifelore.agent.live.task_result import TaskResult
from lifelore.agent.live.task_stream import TaskStream
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import mean_start_value, optimal_q
from lifelore.core.protocols import Record
from lifelore.memory import Memory


class SearchedTasks:
    """Tasks with hidden goals, and what each agent knows; see `TasksOfLife`.

    Parameters
    ----------
    settings : LifeSettings
    names : list of str
        Agents that live the same tasks.
    memory : Memory
    pool : Executor
        Runs the agents side by side.
    """

    how = SEARCHED

    def __init__(self, settings: LifeSettings, names: list[str], memory: Memory, pool: Executor) -> None:
        self.names = names
        self._settings, self._memory, self._pool = settings, memory, pool
        self._lores: dict[str, Lore] = {}

    @property
    def lore(self) -> Lore:
        """Knowledge of the first agent."""
        return self._lores[self.names[0]]

    def settle(self, place: Place, places: OwnPlaces) -> None:
        """Live in this place from now on."""
        settings = self._settings
        self._stream = TaskStream(place.world, settings, place.grid.frame, places.start)
        self._sight = sight_lists(settings.sensor, place)
        self._place, self._scope = place, prior_scope(place.world, settings.prior.condition)

    def recall(self) -> None:
        """The first agent knows what memory holds; at the start all agents do, and then learn by themselves."""
        first = self._recalled()
        self._lores = self._lores or {name: first.copy() for name in self.names}
        self._lores[self.names[0]] = first

    def carry(self) -> float:
        """Take over what each agent knew, where it agrees with the new place; the share for the first agent."""
        first, lores, agreement = self._recalled(), {}, 0.0
        for i, name in enumerate(self.names):
            lore, old = first.copy() if i else first, self._lores[name]
            lore.model, share = carried_model(old, self._place, self._memory)
            if i and self._scope.key == old.scope.key:
                lore.prior = old.prior
            if not i:
                agreement = share
            lores[name] = lore
        self._lores = lores
        return agreement

    def _recalled(self) -> Lore:
        alpha0 = self._settings.prior.alpha0
        return Lore.recalled(self._place.world, self._scope, alpha0, self._memory, self._place.grid)

    def live(self, number: int, seq: int, own: OwnGoal | None, stop: Event) -> LivedByAll:
        """Live a task with each agent; they learn on the same random streams."""
        task = self._stream.task(number, own and own.state)
        tables = task.tables()
        optimal = mean_start_value(tables, optimal_q(tables, task.domain.discount).max(axis=1))
        if optimal <= 0:
            raise InputError(
                f"discount must leave the goal of task {number} a positive value at its starts, "
                f"got {task.domain.discount}; use a larger discount"
            )
        world = self._place.world
        shared = SharedTask(self._settings, world, self._sight, self._stream, task, tables, optimal, number, stop)
        try:
            futures = {
                name: self._pool.submit(shared.live, AGENTS[name], self._lores[name]) for name in self.names
            }
            results = {name: future.result() for name, future in futures.items()}
        except BaseException:
            stop.set()
            raise
        goal = int(task.goal)  # type: ignore[arg-type]
        records = {name: self._learn(name, results[name], goal) for name in self.names}
        return LivedByAll(goal, results, records[self.names[0]], {"optimal_return": optimal}, self._known())

    def _learn(self, name: str, result: TaskResult, goal: int) -> list[Record]:
        """Add a finished task to the knowledge of one agent; return the records that memory is to store."""
        kind, lore, records = AGENTS[name], self._lores[name], []
        if kind.uses_prior and self._settings.prior.condition != "none":
            records.append(lore.learn_prior(result.best, goal, self._settings.prior.weight))
        if kind.remembers and self._settings.learner == "model":
            records.append(lore.model_news())
            if self._settings.destinations and result.reached:
                records.append(lore.goals.found(goal))
        return [record for record in records if len(record.slots)]

    def _known(self) -> dict[str, int]:
        """Number of places that the first agent knows, if it remembers any."""
        if not AGENTS[self.names[0]].remembers or self._settings.learner != "model":
            return {}
        return {"places": int((self.lore.model.percept >= 0).sum())}

    def summary(self, tasks: list[dict]) -> dict:
        """Means of each agent over thirds of the tasks, and ratios to `scratch`."""
        return summarise(tasks)
