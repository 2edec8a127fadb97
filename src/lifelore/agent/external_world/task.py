"""Learns one task in an external world by the Q-learning of `lifelore.core.learning.q_learning`, step by step.

Such a world has no tables: states and contexts get their rows when they are first met, and returns are observed,
not computed.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from threading import Event

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import TRACE
from lifelore.agent.external_world.context_code import ContextCodes
from lifelore.agent.external_world.useful_actions import EpisodeReturns, useful_actions
from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.core.compiled.random_state import random_state
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import cumulative, epsilon_greedy
from lifelore.core.protocols import World

STOP_CHECK = 200
"""Steps between checks of the stop event."""


class ExternalLearner:
    """One agent on one task: its Q-values, and rows of the prior for the contexts met.

    q : state to (1, n_actions) values, 0 at first
    visited : the (state, context code) pairs in which it acted, in the order met
    returns : the returns of its episodes, and of the actions taken in them
    """

    def __init__(
        self, n_actions: int, prior: ActionPrior | None, guidance: PriorSettings, own: np.random.Generator
    ):
        self.n_actions, self.prior, self.guidance, self.generator = n_actions, prior, guidance, own
        self.random = random_state(own)
        self.q: dict[Hashable, NDArray[np.float64]] = defaultdict(lambda: np.zeros((1, n_actions)))
        self.visited: dict[tuple[Hashable, int], None] = {}
        self.returns = EpisodeReturns(n_actions)
        self._rows: dict[int, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}

    def act(self, state: Hashable, code: int, epsilon: float) -> int:
        """Draw the ε-greedy action (Alg. 2, line 5)."""
        if code not in self._rows:
            self._rows[code] = self._rows_of(code)
        explore, ties = self._rows[code]
        self.visited[state, code] = None
        return epsilon_greedy(self.q[state], 0, explore, ties, 0, epsilon, self.random)

    def _rows_of(self, code: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Cumulative exploration probabilities and tie weights, both (1, n_actions)."""
        probs = np.full((1, self.n_actions), 1 / self.n_actions)
        if self.prior is not None:
            probs = self.prior.probs([code], self.guidance.form, generator=self.generator)
        ties = np.maximum(probs, TRACE) if self.guidance.ties == "prior" else np.ones_like(probs)
        return cumulative(probs), ties

    def value(self, state: Hashable) -> float:
        """max_a Q(s, a)."""
        return float(self.q[state].max())

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts (n,) of the visited states, and their useful actions, see `useful_actions`."""
        codes = np.array([code for _, code in self.visited], np.int64)
        q = np.array([self.q[state][0] for state, _ in self.visited]).reshape(-1, self.n_actions)
        return codes, useful_actions(q, list(self.visited), self.returns)


@dataclass(frozen=True)
class ExternalTask:
    """One task that several agents learn; `seeds` holds the seed of each episode, the same for all.

    watch : called with each transition (state, action, next state, reward, terminated)
    """

    world: World
    codes: ContextCodes
    learning: QLearning
    discount: float
    index: int
    seeds: list[int]
    stop: Event
    watch: Callable[[Hashable, int, Hashable, float, bool], None] | None = None

    def live(self, learner: ExternalLearner) -> dict:
        """Learn the task; return the result as JSON data, see `task_measures`.

        Raises
        ------
        InputError
            A reward is not finite, or a context has no code.
        Stopped
            The stop event is set.
        """
        epsilons = self.learning.schedule(self.discount).epsilon.tolist()
        reached = [
            self._episode(learner, seed, epsilon) for seed, epsilon in zip(self.seeds, epsilons, strict=True)
        ]
        return task_measures(learner.returns.returns[-len(reached) :], any(reached))

    def _episode(self, learner: ExternalLearner, seed: int, epsilon: float) -> bool:
        """One episode; whether it was terminated with a positive reward."""
        state, reward, total, factor = self.world.reset(self.index, seed), 0.0, 0.0, 1.0
        steps: list[tuple[Hashable, int, int]] = []
        terminated = False
        for step in range(self.learning.step_cap):
            if step % STOP_CHECK == 0 and self.stop.is_set():
                raise Stopped
            code = self.codes[self.world.context(state, reward)]
            action = learner.act(state, code, epsilon)
            following, reward, terminated, truncated = self.world.step(action)
            check_reward(reward, action, self.index)
            future = 0.0 if terminated else self.discount * learner.value(following)
            q = learner.q[state]
            q[0, action] += self.learning.learning_rate * (reward + future - q[0, action])
            steps.append((state, code, action))
            if self.watch is not None:
                self.watch(state, action, following, reward, terminated)
            total, factor, state = total + factor * reward, factor * self.discount, following
            if terminated or truncated:
                break
        learner.returns.add(steps, total, terminated)
        return terminated and reward > 0


def check_reward(reward: float, action: int, task: int) -> None:
    """InputError if a reward is not finite."""
    if not math.isfinite(reward):
        raise InputError(
            f"reward must be a finite number, got {reward} for action {action} in task {task}; "
            "correct the world's step"
        )


def task_measures(returns: Sequence[float], reached: bool) -> dict:
    """The measures of an agent in a task as JSON data.

    Parameters
    ----------
    returns : sequence of float
        Discounted return of each episode, at least one.
    reached : bool
        Whether an episode was terminated with a positive reward.
    """
    last = returns[-max(1, len(returns) // 10) :]
    return {
        "first_return": returns[0],
        "reached": reached,
        "final_return": sum(last) / len(last),
        "mean_return": sum(returns) / len(returns),
        **dict.fromkeys(("collisions", "steps_to_80", "episodes_to_80")),
    }
