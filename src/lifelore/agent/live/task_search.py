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
from lifelore.core.learning.sight_search import FOUND_STEP, explore_by_sight, new_sight_search
from lifelore.core.learning.tour_search import explore_on_tour
from lifelore.core.mdp import Tables, Task
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld

SightLists = tuple[NDArray[np.int64], NDArray[np.int32]]
"""Begin (n_states + 1,) and states in sight (n_pairs,), as in `SightSearch`."""
CHECK_EVERY, CHECK_EVERY_BY_SIGHT = 100, 10
"""Steps between two evaluations of the greedy policy, by touch and by sight; the same for every agent."""
NEAR = 1e-9
"""Share of the optimal return around the threshold within which the exact value decides. It is far larger than the
rounding error of the value that is updated step by step."""


@dataclass(frozen=True)
class TaskSearch:
    """One task that every agent learns, on the same random streams, so that their comparison is paired.

    settings, world : of the life
    sight : places in sight of each place; None without a lidar
    number : of the task in the robot's life
    task, tables : the task, as object and as arrays
    optimal : mean value of the optimal policy at the task's starts
    stop : set to stop early
    """

    settings: LifeSettings
    world: GridWorld
    sight: SightLists | None
    number: int
    task: Task
    tables: Tables
    optimal: float
    stop: Event

    def live(self, kind: AgentKind, lore: Lore) -> TaskResult:
        """Learn the task with an agent of this kind; changes the model in `lore`.

        It explores until the greedy policy has 80 % of the optimal value, or the cap is reached.

        With a lidar the learner perceives places at a distance, else by touch. It may then know enough as soon as
        it sees the goal; it still walks to the end of that episode, which counts for the returns and the model
        alone. An agent that remembers visits the places known before the task in the order of a tour.

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
        sight = self.sight and new_sight_search(*self.sight, tables, lore.model)
        tour = lore.known_tour() if kind.remembers and sight is None else None
        curve, max_steps = new_curve(self.settings.episode_cap(n)), self.settings.step_cap
        known = KnownValue(tables, lore.model, learner, discount)
        task = tables, lore.model, self._perceived(kind, lore), kind.exploration_strategy, learner

        def run(budget: int) -> int:
            if sight is not None:
                return explore_by_sight(*task, sight, curve, max_steps, discount, budget)
            if tour is not None:
                return explore_on_tour(*task, tour, curve, max_steps, discount, budget)
            return explore(*task, curve, max_steps, discount, budget)

        def value() -> float:
            mean = known.update()
            return known.exact() if abs(mean - THRESHOLD * self.optimal) < NEAR * self.optimal else mean

        found = self._until_learnt(run, value, learner.cursor, curve)
        while sight is not None and found["reached"] and learner.cursor[STEP]:
            run(1)
        episode, step = int(learner.cursor[EPISODE]), int(learner.cursor[STEP])
        if step:
            curve.returns[episode], curve.steps[episode] = learner.running[0], step
        seen = -1 if sight is None else int(sight.found[FOUND_STEP])
        return TaskResult(
            **found,
            first_return=float(curve.returns[0]),
            steps_to_goal=seen if seen >= 0 else _first_arrival(curve, max_steps),
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
        codes, row = np.unique(lore.scope.contexts, return_inverse=True)
        probs = posterior_mean(lore.prior, codes, lore.scope.coarser)
        return StateInfo(percepts, row.astype(np.int32), try_costs(probs))

    def _until_learnt(
        self, run: Callable[[int], int], value: Callable[[], float], cursor: NDArray[np.int64], curve: Curve
    ) -> dict[str, Any]:
        """Learn until the `value` of the greedy policy reaches the threshold, or until no episode is left.

        `run` learns for a number of steps at most, and returns the number of steps that it made.
        """
        every = CHECK_EVERY if self.sight is None else CHECK_EVERY_BY_SIGHT
        total, reached = 0, False
        while not reached:
            if self.stop.is_set():
                raise Stopped
            steps = run(every)
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
