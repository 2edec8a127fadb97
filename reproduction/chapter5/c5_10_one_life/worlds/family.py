"""A family of tasks: Gymnasium environments whose hidden type differs between tasks, and how a life meets them."""

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

import gymnasium

from lifelore.domains.task_stream import TaskStream

USUAL = 0.8
"""Probability that a task has the usual type of its context."""


@dataclass(frozen=True)
class Family:
    """Tasks of one kind.

    Parameters
    ----------
    types : tuple of str
        Hidden types.
    make : callable
        ``make(type, seed)``: the environment of a type in the life of this seed. Layouts belong to the life.
        ``reset(seed=)`` decides where an episode starts, and all luck in it.
    state, features : callable
        Of an observation: the state, and what the action prior may look at.
    episodes, max_steps : int
        Episodes of a task, and most steps of an episode.
    discount : float
    learner : str
        The learner of `LongLivedAgent` and of all that are compared with it.
    """

    types: tuple[str, ...]
    make: Callable[[str, int], gymnasium.Env]
    state: Callable[[Any], Hashable]
    features: Callable[[Any], Hashable]
    episodes: int = 20
    max_steps: int = 60
    discount: float = 0.95
    learner: str = "q"

    def stream(self, seed: int) -> TaskStream:
        """The tasks of a life: each context is as frequent as any other, and has a usual type of its own.

        A context shows its usual type in `USUAL` of its tasks: by loyalty, or because it is drawn among all.
        """
        by_chance = 1 / len(self.types)
        loyalty = (USUAL - by_chance) / (1 - by_chance)
        return TaskStream(self.types, seed, len(self.types), 0.0, loyalty)


def as_tuple(observation: Any) -> tuple[int, ...]:
    """An observation of ``MultiDiscrete`` as a tuple."""
    return tuple(observation.tolist())
