"""Searches for the hidden goal of one task by the model-based learner."""

from collections.abc import Callable
from dataclasses import dataclass
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.back_off import posterior_mean
from lifelore.action.priors.exploration import try_costs
from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.baselines import AgentKind
from lifelore.agent.live.life_settings import LifeSettings
from lifelore.agent.live.lore import Lore
from lifelore.agent.live.task_result import THRESHOLD, TaskResult
from lifelore.core.learning.curve import EPISODE, STEP, Curve, first_episodes, new_curve
from lifelore.core.learning.known_value import KnownValue
from lifelore.core.learning.known_world import best_known_actions, known_policy, unknown_world
from lifelore.core.learning.model_learning import StateInfo, check_deterministic, explore, new_model_learner
from lifelore.core.learning.tour_search import explore_on_tour
from lifelore.core.mdp import Tables, Task
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import MOVE_BITS, GridWorld

CHECK_EVERY = 100
"""Steps between two evaluations of the greedy policy, the same for every agent."""
NEAR = 1e-9
"""Share of the optimal return around the threshold within which the exact value decides. It is far larger than the
rounding error of the value that is updated step by step."""


@dataclass(frozen=True)
class TaskSearch:
    """One task that every agent learns, on the same random streams, so that their comparison is paired.

    settings, world : of the life
    number : of the task in the robot's life
    task, tables : the task, as object and as arrays
    optimal : mean value of the optimal policy at the task's starts
    stop : set to stop early
    """

    settings: LifeSettings
    world: GridWorld
    number: int
    task: Task
    tables: Tables
    optimal: float
    stop: Event

    def live(self, kind: AgentKind, lore: Lore) -> TaskResult:
        """Learn the task with an agent of this kind; changes the model in `lore`.

        It explores until the greedy policy has 80 % of the optimal value, or the cap is reached. An agent that
        remembers visits the places known before the task in the order of a tour.

        Raises
        ------
        Stopped
            The stop event is set.
        """
        tables, discount, n = self.tables, self.task.domain.discount, self.world.n_states
        check_deterministic(tables)
        if not kind.remembers:
            lore.model = unknown_world(n, tables.n_actions)
        learner = new_model_learner(n, tables.n_actions, self._stream("world"), self._stream("own"))
        tour = lore.known_tour() if kind.remembers else None
        curve, max_steps = new_curve(self.settings.episode_cap(n)), self.settings.step_cap
        known = KnownValue(tables, lore.model, learner, discount)
        task = tables, lore.model, self._perceived(kind, lore), kind.exploration_strategy, learner

        def run(budget: int) -> int:
            if tour is not None:
                return explore_on_tour(*task, tour, curve, max_steps, discount, budget)
            return explore(*task, curve, max_steps, discount, budget)

        def value() -> float:
            mean = known.update()
            return known.exact() if abs(mean - THRESHOLD * self.optimal) < NEAR * self.optimal else mean

        found = self._until_learnt(run, value, learner.cursor, curve)
        episode, step = int(learner.cursor[EPISODE]), int(learner.cursor[STEP])
        if step:
            curve.returns[episode], curve.steps[episode] = learner.running[0], step
        return TaskResult(
            **found,
            first_return=float(curve.returns[0]),
            steps_to_goal=_first_arrival(curve, max_steps),
            final_return=known.exact(),
            policy=known_policy(lore.model, learner.place),
            best=best_known_actions(lore.model, learner.place),
            curve=first_episodes(curve, episode + (step > 0)),
            complete=episode,
        )

    def _stream(self, name: str) -> np.random.Generator:
        """A random stream of this task, which all agents share: "world" draws starts, "own" an agent's choices."""
        return stream(self.settings.seed, "task", self.number, name)

    def _perceived(self, kind: AgentKind, lore: Lore) -> StateInfo:
        percepts = self.world.percepts
        if not kind.uses_prior:
            return StateInfo(percepts, np.zeros(len(percepts), np.int32), np.zeros((1, self.tables.n_actions)))
        codes, row = np.unique(percepts, return_inverse=True)
        probs = posterior_mean(lore.prior, codes, (MOVE_BITS,))
        return StateInfo(percepts, row.astype(np.int32), try_costs(probs))

    def _until_learnt(
        self, run: Callable[[int], int], value: Callable[[], float], cursor: NDArray[np.int64], curve: Curve
    ) -> dict[str, Any]:
        """Learn until the `value` of the greedy policy reaches the threshold, or until no episode is left.

        `run` learns for a number of steps at most, and returns the number of steps that it made.
        """
        total, reached = 0, False
        while not reached:
            if self.stop.is_set():
                raise Stopped
            steps = run(CHECK_EVERY)
            if steps == 0:
                break
            total += steps
            reached = bool(value() >= THRESHOLD * self.optimal)
        episodes = len(curve.returns)
        return {
            "reached": reached,
            "steps_to_80": total if reached else episodes * self.settings.step_cap,
            "episodes_to_80": int(cursor[EPISODE] + (cursor[STEP] > 0)) if reached else episodes,
            "collisions": int(curve.collisions.sum()),
        }


def _first_arrival(curve: Curve, max_steps: int) -> int:
    """Steps until the first episode that reached its goal had ended; the cap if none did."""
    if not curve.reached.any():
        return len(curve.returns) * max_steps
    return int(curve.steps[: curve.reached.argmax() + 1].sum())
