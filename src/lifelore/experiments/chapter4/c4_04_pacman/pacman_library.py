"""Pacman's library: a policy for each ghost by Q-learning, and the returns of each policy against each ghost.

Without a discount, waiting has the same value as winning, and the learnt greedy policy dithers until the episode
is cut. So training discounts, although the claim's learners do not (errata).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.q_learning import (
    QLearner,
    Rows,
    Schedule,
    cumulative,
    learn,
    new_learner,
    uniform_rows,
)
from lifelore.core.mdp import Tables
from lifelore.core.planning.episode_value import return_moments
from lifelore.core.planning.episodes import episode_returns
from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import MAX_STEPS, N_ACTIONS, STRATEGIES, PacmanMaze, PacmanTask

GREATEST = 140.0
"""Return of an episode that is won."""


@dataclass(frozen=True, eq=False)
class Arena:
    """A task with its tables, and the rows that a learner reads: it sees observations, not states."""

    task: PacmanTask
    tables: Tables
    rows: Rows

    @classmethod
    def of(cls, task: PacmanTask) -> "Arena":
        """Enumerate a task."""
        tables = task.tables()
        return cls(task, tables, uniform_rows(tables)._replace(q_row=task.observation_of))

    def moments(self, probs: NDArray[np.float64]) -> tuple[float, float]:
        """Exact mean and standard deviation of a policy's return."""
        return return_moments(self.tables, self.rows.q_row, probs, MAX_STEPS)

    def returns(self, probs: NDArray[np.float64], n: int, stream_of: tuple) -> NDArray[np.float64]:
        """Returns of `n` episodes of a policy."""
        world, own = stream(*stream_of, "world"), stream(*stream_of, "policy")
        return episode_returns(self.tables, self.rows.q_row, cumulative(probs), MAX_STEPS, n, world=world, own=own)

    def begin(self, stream_of: tuple) -> QLearner:
        """A Q-learner before its first episode."""
        world, own = stream(*stream_of, "world"), stream(*stream_of, "learner")
        return new_learner(self.task.n_observations, N_ACTIONS, world, own)

    def learn(self, learner: QLearner, schedule: Schedule) -> Curve:
        """Q-learning for the episodes of `schedule`; a later call with the same learner goes on."""
        n = len(schedule.epsilon)
        curve = new_curve(n)
        learner.cursor[:2] = 0
        learn(self.tables, self.rows, schedule, learner, curve, n * MAX_STEPS)
        return curve


def arenas(maze: PacmanMaze, foods: Sequence[int]) -> list[Arena]:
    """The four tasks of one layout of foods, by type."""
    return [Arena.of(PacmanTask(maze, tuple(foods), strategy)) for strategy in STRATEGIES]


def falling(start: float, n_episodes: int) -> NDArray[np.float64]:
    """`start`, less start / N after each of N episodes."""
    return start * (1 - np.arange(n_episodes) / n_episodes)


def greedy(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """The greedy policy as probabilities (n_rows, n_actions), ties alike."""
    best = q == q.max(axis=1, keepdims=True)
    return best / best.sum(axis=1, keepdims=True)


def trained_policies(settings: Mapping, here: Sequence[Arena], stream_of: tuple) -> NDArray[np.float64]:
    """The policy learnt for each type, (n_types, n_observations, n_actions)."""
    n = settings["training_episodes"]
    rates = falling(settings["training_rate"], n)
    schedule = Schedule(falling(settings["training_epsilon"], n), rates, MAX_STEPS, settings["training_discount"])
    policies = []
    for arena in here:
        learner = arena.begin((*stream_of, "training", arena.task.strategy))
        arena.learn(learner, schedule)
        policies.append(greedy(learner.q))
    return np.array(policies)


def exact_moments(here: Sequence[Arena], policies: NDArray[np.float64]) -> tuple[NDArray, NDArray]:
    """Exact mean and deviation of every policy's return on every type, each (n_types, n_policies)."""
    found = np.array([[arena.moments(policy) for policy in policies] for arena in here])
    return found[..., 0], found[..., 1]


def sampled_returns(here: Sequence[Arena], policies: NDArray[np.float64], n: int, stream_of: tuple) -> NDArray:
    """Returns of `n` episodes of every policy on every type, (n_types, n_policies, n)."""
    return np.array(
        [
            [
                arena.returns(policy, n, (*stream_of, arena.task.strategy, number))
                for number, policy in enumerate(policies)
            ]
            for arena in here
        ]
    )
