"""Learners of a task's policy: Q-learning by table, guided by the action prior, and learners of the user.

``"q"`` learns each step once and replays each episode backwards when it ends, so that a reward reaches the whole
episode at once (Lin 1992). ``"model"`` also learns from remembered steps after each step (Dyna, Sutton 1990).
``"textbook"`` learns each step once, at a constant rate.
"""

from collections.abc import Callable, Hashable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.any_tasks.moves import Step
from lifelore.agent.any_tasks.policies import QTable
from lifelore.agent.external_world.task import ExternalLearner
from lifelore.agent.external_world.useful_actions import EpisodeReturns
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import cumulative, epsilon_greedy

Learner = Callable[[Any, ActionPrior, Any], Callable[[Any], int]]
"""``learner(env, prior, start) -> policy``: the environment, whose episodes it may play; the action prior by
code of the features; and the policy to start from, or None. The policy gives an action for an observation."""
TABLES = {"q": (True, 0), "model": (True, 20), "textbook": (False, 0)}
"""Learners by name: whether episodes are replayed, and the number of remembered steps after each step."""
HALF, LEAST_RATE = 10.0, 0.2
"""Times that a move is learnt until its rate is a half, and the least share of the first rate."""


def checked_learner(learner: "str | Learner") -> "str | Learner":
    """The learner; InputError where no learner has this name."""
    if not callable(learner) and learner not in TABLES:
        raise InputError(f"learner must be {', '.join(TABLES)} or a function, got {learner!r}")
    return learner


TRUST = 0.5
"""Share of exploration by the action prior; the rest is uniform: a new type may want what none wanted before."""


class CautiousLearner(ExternalLearner):
    """A learner by table that trusts the action prior only by half, and not at all where it is not `guided`."""

    guided = True

    def act(self, state: Hashable, code: int, epsilon: float) -> int:
        """Draw the ε-greedy action; the context counts where the learner is guided."""
        if self.guided:
            return super().act(state, code, epsilon)
        self.visited[state, code] = None
        even = np.ones((1, self.n_actions))
        return epsilon_greedy(self.q[state], 0, cumulative(even / self.n_actions), even, 0, epsilon, self.random)

    def _rows_of(self, code: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        if self.prior is None:
            return super()._rows_of(code)
        probs = self.prior.probs([code], self.guidance.form, generator=self.generator)
        probs = TRUST * probs + (1 - TRUST) / self.n_actions
        return cumulative(probs), probs


class Player(Protocol):
    """What acts in a task, and learns from each move that it makes."""

    def knows(self, state: int) -> bool:
        """Whether a state, by code, was met before."""
        ...

    def act(self, state: int, context: int, explore: bool) -> int:
        """The action in a state and context, by code; exploring now and then, or not."""
        ...

    def observe(self, step: Step) -> None:
        """Learn from a step."""
        ...

    def end_episode(self, steps: list[Step], earned: float, ended: bool) -> None:
        """Learn from an episode; `ended`: the world terminated it."""
        ...

    def policy(self) -> Any:
        """What was learnt."""
        ...

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts (n,) of the visited states, and their useful actions (n, n_actions)."""
        ...


class TableLearner:
    """Learns one task by table, over codes of states; a `Player`.

    Parameters
    ----------
    name : str
        Of `TABLES`.
    n_actions : int
    prior : ActionPrior, optional
        Guides exploration and breaks ties; without it both are uniform.
    learning : QLearning
    discount : float
    guidance : PriorSettings
    generator : numpy generator
    start : QTable, optional
        Values to start from; 0 by default.
    met : callable, optional
        ``met(state, action)``: how often tasks of the type have met a move; what is well known changes slowly.
    """

    def __init__(
        self,
        name: str,
        n_actions: int,
        prior: ActionPrior | None,
        learning: QLearning,
        discount: float,
        guidance: PriorSettings,
        generator: np.random.Generator,
        start: QTable | None = None,
        met: Callable[[int, int], float] | None = None,
    ) -> None:
        self.replays, self.planned = TABLES[name]
        self.learner = CautiousLearner(n_actions, prior, guidance, generator)
        self.rate, self.discount, self.generator = learning.learning_rate, discount, generator
        self.epsilons = learning.schedule(discount).epsilon.tolist()
        self.episode = 0
        self.met, self._number = met, dict[tuple[int, int], float]()
        self.remembered: list[Step] = []
        if start is not None:
            self.learner.q.update({state: row[None].copy() for state, row in start.values.items()})

    def knows(self, state: int) -> bool:
        """Whether a state was met before."""
        return state in self.learner.q

    def act(self, state: int, context: int, explore: bool) -> int:
        """The ε-greedy action, or the greedy one."""
        epsilon = self.epsilons[min(self.episode, len(self.epsilons) - 1)] if explore else 0.0
        return self.learner.act(state, context, epsilon)

    def observe(self, step: Step) -> None:
        """Learn from a step, and from remembered steps."""
        self._learn(step)
        if self.planned:
            self.remembered.append(step)
            for place in self.generator.integers(len(self.remembered), size=self.planned).tolist():
                self._learn(self.remembered[place])

    def end_episode(self, steps: list[Step], earned: float, ended: bool) -> None:
        """Learn the episode once more, backwards."""
        if self.replays:
            for step in reversed(steps):
                self._learn(step)
        self.learner.returns.add([(step.state, step.context, step.action) for step in steps], earned, ended)
        self.episode += 1
        # As long as all episodes earn the same, the prior may hide what pays here: every second one is free of it.
        earned_more = min(self.learner.returns.returns) < max(self.learner.returns.returns)
        self.learner.guided = earned_more or self.episode % 2 == 0

    def take_over(self, steps: list[Step]) -> None:
        """Learn steps that another player has made."""
        for step in reversed(steps):
            self.learner.visited[step.state, step.context] = None
            self._learn(step)
        self.remembered += steps

    def policy(self) -> QTable:
        """The values that were learnt."""
        return QTable({state: row[0] for state, row in self.learner.q.items()})  # pyright: ignore

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts (n,) of the visited states, and their useful actions (n, n_actions)."""
        return self.learner.best()

    def _learn(self, step: Step) -> None:
        future = 0.0 if step.ended else self.discount * self.learner.value(step.following)
        q = self.learner.q[step.state]
        q[0, step.action] += self._rate((step.state, step.action)) * (step.reward + future - q[0, step.action])

    def _rate(self, move: tuple[int, int]) -> float:
        """The learning rate of a move, which falls with the number of times that it was learnt."""
        if not self.replays:
            return self.rate
        number = self._number.get(move)
        if number is None:
            number = 0.0 if self.met is None else self.met(*move)
        self._number[move] = number + 1
        return self.rate * max(LEAST_RATE, 1 / (1 + number / HALF))


class FixedPolicy:
    """A policy of the user's learner, which learns nothing more here; a `Player`.

    Parameters
    ----------
    function : callable
        Observation to an action of the environment.
    observation : callable
        The present observation, without arguments.
    first_action : int
        The environment's number of the first action.
    n_actions : int
    """

    def __init__(
        self, function: Callable[[Any], int], observation: Callable[[], Any], first_action: int, n_actions: int
    ) -> None:
        self.function, self.observation, self.first_action = function, observation, first_action
        self.returns = EpisodeReturns(n_actions)
        self.visited: dict[tuple[int, int], None] = {}

    def knows(self, state: int) -> bool:
        """Always: the user's policy says what it does anywhere."""
        return True

    def act(self, state: int, context: int, explore: bool) -> int:
        """The policy's action for the present observation."""
        return int(self.function(self.observation())) - self.first_action

    def observe(self, step: Step) -> None:
        """Nothing is learnt."""

    def end_episode(self, steps: list[Step], earned: float, ended: bool) -> None:
        """Count the actions of the episode for the action prior."""
        self.visited.update(dict.fromkeys((step.state, step.context) for step in steps))
        self.returns.add([(step.state, step.context, step.action) for step in steps], earned, ended)

    def policy(self) -> Callable[[Any], int]:
        """The user's policy."""
        return self.function

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts (n,) of the visited states, and the actions taken in the best tenth of the episodes."""
        visited = list(self.visited)
        return np.array([context for _, context in visited], np.int64), self.returns.taken_in_best(visited)
