"""Schedules of ε and α: the printed one, and geometric ones (the first ε, its factor an episode, the least ε)."""

from collections.abc import Mapping, Sequence

from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import Schedule

PRINTED = "printed"
"""α = ε = 0.5, each less 0.5/N in each of N episodes: the only schedule that the thesis prints (§4.6.3)."""
FIRST = 0.5

Epsilon = str | Sequence[float]
"""`PRINTED`, or three numbers."""


def schedule_of(settings: Mapping, epsilon: Epsilon) -> Schedule:
    """ε and α of each episode; `settings` has ``episodes``, ``max_steps``, ``learning_rate`` and ``discount``.

    The learning rate belongs to geometric schedules; the printed schedule has its own.
    """
    n, max_steps = settings["episodes"], settings["max_steps"]
    if isinstance(epsilon, str):
        return QLearning(n, max_steps, FIRST, FIRST, annealed=True).schedule(settings["discount"])
    first, factor, least = epsilon
    plan = QLearning(n, max_steps, settings["learning_rate"], first, factor, least)
    return plan.schedule(settings["discount"])
