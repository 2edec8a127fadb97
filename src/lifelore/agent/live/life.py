"""`live`: an agent lives through a stream of tasks, each better because of what the earlier ones taught."""

import os
import time
import uuid
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field, fields
from threading import Event

import numpy as np

from lifelore.action.priors.back_off import posterior_mean
from lifelore.action.priors.exploration import prior_rows, try_costs
from lifelore.agent.live.baselines import ROSTER, Kind, companions
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.agent.live.model_task import live_model_task
from lifelore.agent.live.q_task import live_q_task
from lifelore.agent.live.summary import summarise
from lifelore.agent.live.task_result import Stopped, TaskResult
from lifelore.agent.live.task_stream import TaskStream
from lifelore.core.errors import InputError
from lifelore.core.learning.known_world import unknown_world
from lifelore.core.learning.model_learning import StateInfo, new_model_learner
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import new_learner, uniform_rows
from lifelore.core.mdp import Tables, Task
from lifelore.core.planning.planning import mean_start_value, optimal_q
from lifelore.core.protocols import Progress, Record
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import WorldSettings, world_from_settings
from lifelore.memory import Memory, open_memory

KEPT = 4
"""Last tasks whose policies are kept for pictures: a long life in a large world must not fill the machine."""


@dataclass
class Life:
    """A finished (or stopped) life: the report, and what pictures are made from.

    report : dict
        The JSON document of ``lifelore live``.
    world : GridWorld
    results : list of dict
        For each task: agent name to `TaskResult`; policies only in the last `KEPT`.
    lore : Lore
        What the first agent knows at the end.
    stopped : bool
        The person asked to stop; the report covers the tasks finished by then.
    """

    report: dict
    world: GridWorld
    results: list[dict[str, TaskResult]] = field(repr=False)
    lore: Lore = field(repr=False)
    stopped: bool = False


Watcher = Callable[[dict, dict[str, TaskResult]], None]
"""Called with a finished task's entry of the report, and what each agent made of the task."""


def live(
    settings: LifeSettings,
    *,
    progress: Progress | None = None,
    stop: Event | None = None,
    watch: Watcher | None = None,
) -> Life:
    """Live through ``settings.tasks`` tasks and keep what was learnt.

    Parameters
    ----------
    settings : LifeSettings
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each task.
    stop : threading.Event, optional
        Set it to end early: the task in progress is given up, all finished ones are kept.
    watch : callable, optional
        Called as ``watch(task, results)`` with each task, once memory has it; see `Watcher`.

    Raises
    ------
    InputError, NotFoundError
        A setting breaks its rule, or the map does.
    StoreError
        Memory refuses; what was learnt before stays in it.
    """
    stop = stop or Event()
    began = time.perf_counter()
    names = companions(settings.agent, settings.learner)
    world = world_from_settings(_world_settings(settings))
    with open_memory(settings.memory) as memory:
        life = _Living(settings, world, names, memory)
        with ThreadPoolExecutor(settings.jobs) as pool:
            results = life.run(pool, progress, stop, watch)
        report = _report(settings, world, life, results, time.perf_counter() - began)
    return Life(report, world, results, life.lores[names[0]], stop.is_set())


def _world_settings(settings: LifeSettings) -> WorldSettings:
    """Every setting that the world knows too; what it has no use for it refuses."""
    names = {field.name for field in fields(WorldSettings)} & {field.name for field in fields(LifeSettings)}
    return WorldSettings(**{name: getattr(settings, name) for name in names})


class _Living:
    """The life under way: everybody's lore, and the memory it is kept in."""

    def __init__(self, settings: LifeSettings, world: GridWorld, names: list[str], memory: Memory) -> None:
        self.settings, self.world, self.names, self.memory = settings, world, names, memory
        self.stream = TaskStream(world, settings)
        self.scope = prior_scope(world, settings.prior)
        # Every agent starts from the same lore and then lives its own life; only the first one's is kept.
        first = Lore.recalled(world, self.scope, settings.alpha0, memory)
        self.lores = {name: first.copy() if i else first for i, name in enumerate(names)}
        self.tasks_before = memory.tasks(settings.robot)
        self.process = f"{os.getpid()}-{uuid.uuid4().hex[:12]}"
        self.finished: list[dict] = []

    def run(
        self, pool: ThreadPoolExecutor, progress: Progress | None, stop: Event, watch: Watcher | None
    ) -> list[dict[str, TaskResult]]:
        results = []
        total = self.settings.tasks
        for done in range(total):
            if stop.is_set():
                break
            try:
                results.append(self._live_task(self.tasks_before + done, done, pool, stop))
                if watch:
                    watch(self.finished[-1], results[-1])
                if done >= KEPT:
                    for result in results[done - KEPT].values():
                        result.drop_arrays()
            except Stopped:
                break
            if progress:
                progress(done + 1, total, f"task {self.tasks_before + done}")
        return results

    def _live_task(self, index: int, seq: int, pool: ThreadPoolExecutor, stop: Event) -> dict[str, TaskResult]:
        task = self.stream.task(index)
        tables = task.tables()
        optimal = mean_start_value(tables, optimal_q(tables, task.domain.discount).max(axis=1))
        if optimal <= 0:
            raise InputError(
                f"discount must leave some of task {index}'s goal at its starts, got {task.domain.discount}; "
                "use a larger one"
            )
        trial = _Trial(self, task, tables, optimal, index, stop)
        try:
            futures = {name: pool.submit(trial.live, name) for name in self.names}
            results = {name: future.result() for name, future in futures.items()}
        except BaseException:
            stop.set()
            raise
        goal = int(task.goal)  # type: ignore[arg-type]
        records = {name: self._learn(name, results[name], goal) for name in self.names}
        about = {"index": index, "goal": self.world.cells[goal].tolist(), "world": self.world.fingerprint}
        self.memory.contribute(
            self.settings.robot, records[self.names[0]], process=self.process, seq=seq, task=about
        )
        agents = {name: result.to_dict() for name, result in results.items()}
        self.finished.append({"index": index, "goal": about["goal"], "optimal_return": optimal, "agents": agents})
        return results

    def _learn(self, name: str, result: TaskResult, goal: int) -> list[Record]:
        """Draw one agent's lessons from a finished task; the records are what its memory gains."""
        kind, lore, records = ROSTER[name], self.lores[name], []
        if kind.uses_prior and self.settings.prior != "none":
            records.append(lore.learn_prior(result.best, goal, self.settings.weight))
        if kind.remembers and self.settings.learner == "model":
            records.append(lore.model_news())
        return [record for record in records if len(record.slots)]


@dataclass(frozen=True)
class _Trial:
    """One task that every agent is given, on the same random streams."""

    living: _Living
    task: Task
    tables: Tables
    optimal: float
    index: int
    stop: Event

    def live(self, name: str) -> TaskResult:
        kind, lore = ROSTER[name], self.living.lores[name]
        if self.living.settings.learner == "q":
            return self._with_q(kind, lore)
        return self._with_model(kind, lore)

    def _with_model(self, kind: Kind, lore: Lore) -> TaskResult:
        settings, world = self.living.settings, self.living.world
        if not kind.remembers:
            lore.model = unknown_world(world.n_states, self.tables.n_actions)
        explorer = new_model_learner(
            world.n_states,
            self.tables.n_actions,
            self.living.stream.world_stream(self.index),
            self.living.stream.own_stream(self.index),
        )
        return live_model_task(
            self.tables,
            self.optimal,
            self.task.domain.discount,
            lore.model,
            self._perceived(kind, lore),
            kind.manner,
            explorer,
            settings.episode_cap(world.n_states),
            settings.step_cap,
            self.stop,
        )

    def _perceived(self, kind: Kind, lore: Lore) -> StateInfo:
        percepts = self.living.world.percepts
        if not kind.uses_prior or self.living.settings.prior == "none":
            return StateInfo(percepts, np.zeros(len(percepts), np.int32), np.zeros((1, self.tables.n_actions)))
        codes, row = np.unique(lore.scope.contexts, return_inverse=True)
        probs = posterior_mean(lore.prior, codes, lore.scope.coarser)
        return StateInfo(percepts, row.astype(np.int32), try_costs(probs))

    def _with_q(self, kind: Kind, lore: Lore) -> TaskResult:
        settings = self.living.settings
        own = self.living.stream.own_stream(self.index)
        rows = uniform_rows(self.tables)
        if kind.uses_prior and settings.prior != "none":
            # A stream of its own: drawing a prior must not move the choices shared with the other agents.
            drawn = stream(settings.seed, "task", self.index, "prior")
            rows = prior_rows(
                self.tables,
                lore.scope.contexts,
                lambda codes: lore.prior.probs(codes, settings.form, generator=drawn),
                settings.ties,
            )
        method = QLearning(
            settings.episode_cap(self.tables.n_states),
            settings.step_cap,
            settings.learning_rate,
            settings.epsilon,
            settings.epsilon_decay,
            settings.epsilon_floor,
        )
        learner = new_learner(
            self.tables.n_states, self.tables.n_actions, self.living.stream.world_stream(self.index), own
        )
        return live_q_task(
            self.tables, self.optimal, rows, method.schedule(self.task.domain.discount), learner, self.stop
        )


def _report(settings: LifeSettings, world: GridWorld, life: _Living, results: list[dict], seconds: float) -> dict:
    return {
        "domain": settings.domain,
        "map": settings.map,
        "n_states": world.n_states,
        "seed": settings.seed,
        "settings": asdict(settings)
        | world.about
        | {
            "discount": world.discount,
            "goal_reward": world.goal_reward,
            "wall_reward": world.wall_reward,
            "episodes": settings.episode_cap(world.n_states),
            "max_steps": settings.step_cap,
            "memory": life.memory.location,
        },
        "tasks": life.finished,
        "summary": summarise(life.finished) if life.finished else {},
        "memory": {"tasks_before": life.tasks_before, "tasks_after": life.memory.tasks(settings.robot)},
        "seconds": round(seconds, 3),
    }
