"""Schedules of ε by three numbers: the first ε, its factor each episode, and the least ε."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import Schedule


def schedule_of(settings: Mapping, epsilon: Sequence[float]) -> Schedule:
    """ε and α of each episode; `settings` has ``episodes``, ``max_steps``, ``learning_rate`` and ``discount``."""
    learning = QLearning(settings["episodes"], settings["max_steps"], settings["learning_rate"], *epsilon)
    return learning.schedule(settings["discount"])


def with_learning_rate(schedule: Schedule, rates: Sequence[float]) -> Schedule:
    """The schedule with α by three numbers: the first α, its factor each episode, and the least α."""
    first, decay, least = rates
    return schedule._replace(alpha=np.maximum(least, first * decay ** np.arange(len(schedule.alpha))))


def schedule_in_words(epsilon: Sequence[float]) -> str:
    """A schedule as a panel's title."""
    first, decay, floor = epsilon
    return f"ε = {first:g}" if decay == 1 else f"ε = {first:g}, × {decay:g} an episode to {floor:g}"


def schedule_in_brief(epsilon: Sequence[float]) -> str:
    """A schedule as a row or column of a table names it, without the least ε."""
    first, decay, _ = epsilon
    return f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}"
