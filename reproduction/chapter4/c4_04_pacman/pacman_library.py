"""Pacman's library: a policy for each ghost by Q-learning, and the returns of each policy against each ghost.

Without a discount, waiting has the same value as winning, and the learnt greedy policy dithers until the episode
is cut. So training discounts, although the claim's learners do not (errata).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from lifelore.core.learning import q_learning
from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.q_learning import QLearner, Rows, Schedule
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import MAX_STEPS, N_ACTIONS, STRATEGIES, PacmanMaze, PacmanTask
from reproduction.engine.learning_run import greedy_probs


def return_moments(
    tables: Tables, row_of: NDArray[np.int32], probs: NDArray[np.float64], max_steps: int
) -> tuple[float, float]:
    """Mean and standard deviation of an episode's return.

    The moments of what is still to come, by state and backwards from the step limit:
    ``E[G] = E[r + G']`` and ``E[G²] = E[r² + 2 r G' + G'²]``.

    Parameters
    ----------
    tables : Tables
    row_of : (n_states,) int32
        Row of `probs` that the policy reads in a state.
    probs : (n_rows, n_actions) float64
        The policy; rows sum to 1.
    max_steps : int
        Steps after which an episode is truncated.
    """
    chances = np.diff(tables.by_pair.outcome_cum, prepend=0.0) * probs[row_of][:, :, None]
    state, action, outcome = np.nonzero(chances)
    chance, reward = chances[state, action, outcome], tables.reward[state, action, outcome]
    goes_on = (tables.event[state, action, outcome] & TERMINAL) == 0
    way = state[goes_on], tables.next_state[state, action, outcome][goes_on]
    shape = tables.n_states, tables.n_states
    onward, paid_onward = (csr_array((x[goes_on], way), shape=shape) for x in (chance, chance * reward))
    now, square_now = (np.bincount(state, chance * x, tables.n_states) for x in (reward, reward**2))
    first, second = np.zeros((2, tables.n_states))
    for _ in range(max_steps):
        second = square_now + 2 * (paid_onward @ first) + onward @ second
        first = now + onward @ first
    mean = first[tables.starts].mean()
    return float(mean), float(np.sqrt(max(second[tables.starts].mean() - mean**2, 0.0)))


Array = NDArray[np.float64]
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
        return cls(task, tables, q_learning.uniform_rows(tables)._replace(q_row=task.observation_of))

    def moments(self, probs: Array) -> tuple[float, float]:
        """Exact mean and standard deviation of a policy's return."""
        return return_moments(self.tables, self.rows.q_row, probs, MAX_STEPS)

    def returns_of_each(self, policies: Array, n: int, stream_of: tuple) -> Array:
        """Returns of `n` episodes of each policy, (n_policies, n)."""
        plays, found = Schedule(np.ones(n), np.zeros(n), MAX_STEPS, 1.0), []
        for number, probs in enumerate(policies):
            observed = self.rows.q_row
            rows = q_learning.uniform_rows(self.tables, probs, context_row=observed)._replace(q_row=observed)
            learner = self.begin((*stream_of, number))  # explores by the policy alone, and learns nothing
            found.append(replace(self, rows=rows).learn(learner, plays).rewards)
        return np.array(found)

    def begin(self, stream_of: tuple) -> QLearner:
        """A Q-learner before its first episode."""
        world, own = stream(*stream_of, "world"), stream(*stream_of, "learner")
        return q_learning.new_learner(self.task.n_observations, N_ACTIONS, world, own)

    def learn(self, learner: QLearner, schedule: Schedule) -> Curve:
        """Q-learning for the episodes of `schedule`; a later call with the same learner goes on."""
        n = len(schedule.epsilon)
        curve = new_curve(n)
        learner.cursor[:2] = 0
        q_learning.learn(self.tables, self.rows, schedule, learner, curve, n * MAX_STEPS)
        return curve


def arenas(maze: PacmanMaze, foods: Sequence[int]) -> list[Arena]:
    """The four tasks of one layout of foods, by type."""
    return [Arena.of(PacmanTask(maze, tuple(foods), strategy)) for strategy in STRATEGIES]


def falling_schedule(epsilon: float, rate: float, n_episodes: int, discount: float) -> Schedule:
    """ε and the learning rate, each less its Nth part after each of N episodes."""
    left = 1 - np.arange(n_episodes) / n_episodes
    return Schedule(epsilon * left, rate * left, MAX_STEPS, discount)


def trained_policies(settings: Mapping, here: Sequence[Arena], stream_of: tuple) -> Array:
    """The policy learnt for each type, (n_types, n_observations, n_actions)."""
    names, policies = ("epsilon", "rate", "training_episodes", "training_discount"), []
    schedule = falling_schedule(*(settings[name] for name in names))
    for arena in here:
        learner = arena.begin((*stream_of, "training", arena.task.strategy))
        arena.learn(learner, schedule)
        policies.append(greedy_probs(learner.q))
    return np.array(policies)


def exact_moments(here: Sequence[Arena], policies: Array) -> tuple[Array, Array]:
    """Exact mean and deviation of every policy's return on every type, each (n_types, n_policies)."""
    moments = np.array([[arena.moments(policy) for policy in policies] for arena in here])
    return moments[..., 0], moments[..., 1]


def sampled_returns(here: Sequence[Arena], policies: Array, n: int, stream_of: tuple) -> Array:
    """Returns of `n` episodes of every policy on every type, (n_types, n_policies, n)."""
    return np.array([arena.returns_of_each(policies, n, (*stream_of, arena.task.strategy)) for arena in here])
