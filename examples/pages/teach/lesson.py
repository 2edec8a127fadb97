"""A person assembles in modified factories, and learners use the prior of these demonstrations (Figure 3.16).

Every step of every demonstration counts, weighted by the person's competence. Thesis: §3.4.8.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.competence import competence_by_steps
from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.mdp import COLLISION, Tables
from lifelore.core.planning.planning import best_actions
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import feature_codes, features
from lifelore.domains.factory.factory import ACTION_NAMES, ASSEMBLED, RAW, FactoryTask
from lifelore.domains.factory.modified_factory import modified_factory

ALPHA0 = 0.1
"""Pseudo-count of every action, as in claim C3.12."""
EPISODES = 100
"""Episodes of a learner."""
LEARNERS = 8
"""Number of new factories, with a learner of each kind in each; more make the curves smoother and take longer."""
MOST_STEPS = 2000
"""Most steps of an episode."""
WITHOUT, SHOWN, SELF = "without a prior", "with your prior", "with a prior from exact policies"


@dataclass(frozen=True, eq=False)
class LessonTask:
    """A factory of its own layout, its task, and what a robot sees there.

    task : FactoryTask
    tables : Tables
    contexts : (n_states,) int64, codes of the terrain around the robot, and of what is to be done next (phi3)
    """

    task: FactoryTask
    tables: Tables
    contexts: NDArray[np.int64]

    @cached_property
    def best(self) -> NDArray[np.bool_]:
        """Best and tied-best actions, (n_states, 6) bool; none where all is assembled."""
        best = best_actions(self.task.optimal_q(self.tables))
        best[self.task.completed] = False
        return best


@cache
def lesson_task(seed: int, kind: str, number: int, components: int) -> LessonTask:
    """A task of the kind ``shown`` or ``tested``; `components` from 1 to 4; more are slow to solve."""
    random = stream(seed, "factory lesson", kind, number)
    factory = modified_factory(random)
    task = factory.task(factory.draw_components(random, components))
    return LessonTask(task, task.tables(), feature_codes(features(task), "phi3"))


class Lesson:
    """The lesson of one person, who assembles one task after another, step by step.

    Parameters
    ----------
    components : int
        Number of components that a task assembles.
    seed : int
        Draws the factories.

    Attributes
    ----------
    shown : list of Demonstration
        `task` of each is the number of its factory, as text.
    number, state, reward : int, int, float
        Of the present task.
    """

    def __init__(self, components: int = 2, seed: int = 0) -> None:
        self.components, self.seed = components, seed
        self.shown: list[Demonstration] = []
        self.number = -1
        self.prior = ActionPrior(len(ACTION_NAMES), ALPHA0)
        self.go_on()

    @property
    def present(self) -> LessonTask:
        """The task that is being demonstrated."""
        return self.task_of(self.number)

    def task_of(self, number: int) -> LessonTask:
        """A task that is demonstrated."""
        return lesson_task(self.seed, "shown", number, self.components)

    @property
    def over(self) -> bool:
        """Whether everything of the present task is assembled."""
        return bool(self.present.task.completed[self.state])

    def go_on(self) -> None:
        """Begin the next task; steps of a task that is not over are dropped."""
        self.number += 1
        self.state, self.reward, self.event = int(self.present.tables.starts[0]), 0.0, 0
        self.states, self.actions = list[int](), list[int]()

    def act(self, action: int) -> None:
        """Take a step of `ACTION_NAMES`; the last step of a task makes its demonstration, and the prior knows it.

        Raises
        ------
        InputError
            There is no such action, the task is over, or it has taken too many steps.
        """
        if isinstance(action, bool) or not isinstance(action, int) or not 0 <= action < len(ACTION_NAMES):
            raise InputError(f"action must lie in [0, {len(ACTION_NAMES)}), got {action!r}")
        if self.over or len(self.actions) >= MOST_STEPS:
            raise InputError(f"the task is over, or has {MOST_STEPS} steps; go on to the next task")
        tables = self.present.tables
        self.states.append(self.state)
        self.actions.append(action)
        self.reward += float(tables.reward[self.state, action, 0])
        self.event = int(tables.event[self.state, action, 0])
        self.state = int(tables.next_state[self.state, action, 0])
        if self.over:
            done = Demonstration(str(self.number), "person", np.array(self.states), np.array(self.actions))
            weights = competence_by_steps([done], lambda _: self.present.best)
            count_demonstrations(self.prior, [done], lambda own: self.present.contexts[own.states], weights)
            self.shown.append(done)

    def view(self) -> dict[str, Any]:
        """The state of the present task as plain data.

        Returns
        -------
        dict
            ``number``, ``shown`` (demonstrations), ``steps``, ``reward``, ``over``, ``collision`` (of the last
            step), ``cell`` (row, column of the robot), ``floor`` (a text for each row: ``#`` wall), ``items``
            (``component``, ``stage``, ``procure``, ``assemble`` with their cells), ``unused`` (cells of the
            stations that the task does not need), ``advice`` (probability by action) and ``advised`` (whether the
            prior has counts here).
        """
        task, context = self.present.task, self.present.contexts[[self.state]]
        factory, cells = task.factory, task.factory.floor.cells
        named = {RAW: "raw", ASSEMBLED: "assembled"}
        items = [
            {
                "component": component + 1,
                "stage": named.get(stage, "procured"),
                "procure": cells[factory.procure_at[component]].tolist(),
                "assemble": cells[factory.assemble_at[component]].tolist(),
            }
            for component, stage in zip(task.components, task.stages[self.state // factory.n_cells], strict=True)
        ]
        # The robot sees the stations of other components as stations too.
        unused = np.delete(np.arange(factory.n_components), list(task.components))
        picture = np.full(factory.floor.shape, "#")
        picture[tuple(cells.T)] = "."
        return {
            "number": self.number, "shown": len(self.shown), "steps": len(self.actions), "reward": self.reward,
            "over": self.over, "collision": bool(self.event & COLLISION), "items": items,
            "cell": cells[self.state % factory.n_cells].tolist(), "floor": ["".join(row) for row in picture],
            "unused": {
                "procure": cells[factory.procure_at[unused]].tolist(),
                "assemble": cells[factory.assemble_at[unused]].tolist(),
            },
            "advice": dict(zip(ACTION_NAMES, self.prior.probs(context)[0].tolist(), strict=True)),
            "advised": not bool(self.prior.unseen(context)[0]),
        }  # fmt: skip

    def curves(self) -> dict[str, Any]:
        """Learning curves in new factories; all learners of a factory meet the same random numbers.

        Returns
        -------
        dict
            By kind of learner ``mean`` and ``deviation`` of the reward of an episode, (`EPISODES`,). The prior
            from exact policies comes from the factories that were demonstrated.
        """
        priors: dict[str, ActionPrior | None] = {WITHOUT: None}
        if self.shown:
            shown = [self.task_of(int(one.task)) for one in self.shown]
            priors |= {SHOWN: self.prior, SELF: self_trained_prior(shown)}
        found = {}
        for name, prior in priors.items():
            rewards = np.array([self._rewards(number, prior) for number in range(LEARNERS)])
            mean, deviation = rewards.mean(axis=0).round(2), rewards.std(axis=0, ddof=1).round(2)
            found[name] = {"mean": mean.tolist(), "deviation": deviation.tolist()}
        return found

    def _rewards(self, number: int, prior: ActionPrior | None) -> NDArray[np.float64]:
        """Reward of each episode of a learner in a new factory, (`EPISODES`,)."""
        task = lesson_task(self.seed, "tested", number, self.components)
        rows = None if prior is None else prior_rows(task.tables, task.contexts, prior.probs)
        learning = QLearning(EPISODES, MOST_STEPS, 0.5, 1.0, 0.95, 0.01)  # as the default of claim C3.12
        world, own = (stream(self.seed, "factory lesson", number, name) for name in ("world", "learner"))
        return learning.learn(task.tables, task.task.domain.discount, world=world, own=own, rows=rows)[1].rewards


def self_trained_prior(tasks: Iterable[LessonTask]) -> ActionPrior:
    """The prior from the exact policies of tasks, every state counted (Eq. 3.7)."""
    prior = ActionPrior(len(ACTION_NAMES), ALPHA0)
    for task in tasks:
        prior.update(task.contexts, task.best)
    return prior
