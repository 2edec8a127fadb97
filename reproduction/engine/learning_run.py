"""One task learnt to the end on streams of its own: what every learning experiment does for each of its runs."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.q_learning import QLearner, Rows, Schedule, learn, new_learner, uniform_rows
from lifelore.core.mdp import Tables
from lifelore.core.streams import stream


def learnt(tables: Tables, stream_of: tuple, rows: Rows | None, schedule: Schedule) -> tuple[Curve, QLearner]:
    """The curve and the learner after all episodes; without `rows` it is plain Q-learning.

    `stream_of` names the task's streams: methods that are compared share the world's, and each has the same own.
    """
    own, world = stream(*stream_of, "learner"), stream(*stream_of, "world")
    learner = new_learner(tables.n_states, tables.n_actions, world, own)
    curve = new_curve(schedule.epsilon.size)
    budget = schedule.epsilon.size * schedule.max_steps
    learn(tables, rows or uniform_rows(tables), schedule, learner, curve, budget)
    return curve, learner


def curves_of(problems: Iterable[Any], rows_for: Callable[[Any], Rows | None], schedule: Schedule) -> list[Curve]:
    """The curve of each problem, which has its ``tables`` and the names of its ``stream``."""
    return [learnt(problem.tables, problem.stream, rows_for(problem), schedule)[0] for problem in problems]


def greedy_probs(q: NDArray[np.float64], epsilon: float = 0.0) -> NDArray[np.float64]:
    """The ε-greedy policy (n_states, n_actions) of the values `q`, ties alike."""
    best = q == q.max(axis=1, keepdims=True)
    return (1 - epsilon) * best / best.sum(axis=1, keepdims=True) + epsilon / q.shape[1]
