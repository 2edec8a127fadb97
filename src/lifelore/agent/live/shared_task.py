"""One task of a life, which every agent learns on the same random streams: settings become learners."""

from dataclasses import dataclass, replace
from threading import Event

import numpy as np

from lifelore.action.priors.back_off import posterior_mean
from lifelore.action.priors.exploration import prior_rows, try_costs
from lifelore.agent.live.baselines import AgentKind
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.model_task import live_model_task
from lifelore.agent.live.q_task import live_q_task
from lifelore.agent.live.sight import SightLists
from lifelore.agent.live.task_result import TaskResult
from lifelore.agent.live.task_stream import TaskStream
from lifelore.core.learning.known_world import unknown_world
from lifelore.core.learning.model_learning import StateInfo, new_model_learner
from lifelore.core.learning.q_learning import new_learner, uniform_rows
from lifelore.core.learning.sight_search import new_sight_search
from lifelore.core.mdp import Tables, Task
from lifelore.core.streams import stream as random_stream
from lifelore.domains.grids.grid_world import GridWorld


@dataclass(frozen=True)
class SharedTask:
    """One task that every agent learns, on the same random streams.

    settings, world, stream : of the life
    sight : places in sight of each place; None without a lidar
    task, tables : the task, as object and as arrays
    optimal : mean value of the optimal policy at the task's starts
    index : number of the task in the robot's life
    stop : set to stop early
    """

    settings: LifeSettings
    world: GridWorld
    sight: SightLists | None
    stream: TaskStream
    task: Task
    tables: Tables
    optimal: float
    index: int
    stop: Event

    def live(self, kind: AgentKind, lore: Lore) -> TaskResult:
        """Learn the task with an agent of this kind; changes the model in `lore`."""
        if self.settings.learner == "q":
            return self._with_q(kind, lore)
        return self._with_model(kind, lore)

    def _with_model(self, kind: AgentKind, lore: Lore) -> TaskResult:
        settings, world, sight = self.settings, self.world, self.sight
        if not kind.remembers:
            lore.model = unknown_world(world.n_states, self.tables.n_actions)
        explorer = new_model_learner(
            world.n_states,
            self.tables.n_actions,
            self.stream.world_stream(self.index),
            self.stream.own_stream(self.index),
        )
        return live_model_task(
            self.tables,
            self.optimal,
            self.task.domain.discount,
            lore.model,
            self._perceived(kind, lore),
            sight and new_sight_search(*sight, self.tables, lore.model),
            lore.known_tour() if kind.remembers and sight is None else None,
            kind.exploration_strategy,
            explorer,
            settings.episode_cap(world.n_states),
            settings.step_cap,
            self.stop,
        )

    def _perceived(self, kind: AgentKind, lore: Lore) -> StateInfo:
        percepts = self.world.percepts
        if not kind.uses_prior or self.settings.prior.condition == "none":
            return StateInfo(percepts, np.zeros(len(percepts), np.int32), np.zeros((1, self.tables.n_actions)))
        codes, row = np.unique(lore.scope.contexts, return_inverse=True)
        probs = posterior_mean(lore.prior, codes, lore.scope.coarser)
        return StateInfo(percepts, row.astype(np.int32), try_costs(probs))

    def _with_q(self, kind: AgentKind, lore: Lore) -> TaskResult:
        settings = self.settings
        own = self.stream.own_stream(self.index)
        rows = uniform_rows(self.tables)
        if kind.uses_prior and settings.prior.condition != "none":
            # A separate stream: a draw of the prior must not change the choices shared with the other agents.
            drawn = random_stream(settings.seed, "task", self.index, "prior")
            rows = prior_rows(
                self.tables,
                lore.scope.contexts,
                lambda codes: lore.prior.probs(codes, settings.prior.form, generator=drawn),
                settings.prior.ties,
            )
        method = replace(
            settings.learning, episodes=settings.episode_cap(self.tables.n_states), max_steps=settings.step_cap
        )
        learner = new_learner(
            self.tables.n_states, self.tables.n_actions, self.stream.world_stream(self.index), own
        )
        return live_q_task(
            self.tables, self.optimal, rows, method.schedule(self.task.domain.discount), learner, self.stop
        )
