"""Factories of a lesson: each task has a layout of its own, what a robot sees in it, and its exact solution.

Thesis: §3.4.4, §3.4.5.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.mdp import Tables
from lifelore.core.planning.planning import best_actions
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import feature_codes, features
from lifelore.domains.factory.factory import FactoryTask
from lifelore.domains.factory.modified_factory import modified_factory

FEATURES = "phi3"
"""What the prior sees: the terrain of the robot's cell and of its four neighbours, and what is to be done next."""
MOST_COMPONENTS = 4
"""Largest number of components of a task: the number of Figure 3.16; more make the exact solution slow."""


@dataclass(frozen=True, eq=False)
class LessonTask:
    """A task of a lesson.

    Parameters
    ----------
    task : FactoryTask
    tables : Tables
    contexts : (n_states,) int64
        Codes of what the robot sees in each state.
    names : tuple
        Names of its streams of random numbers.
    """

    task: FactoryTask
    tables: Tables
    contexts: NDArray[np.int64]
    names: tuple[str | int, ...]

    @cached_property
    def best(self) -> NDArray[np.bool_]:
        """Best and tied-best actions, (n_states, 6) bool; none where all is assembled."""
        best = best_actions(self.task.optimal_q(self.tables))
        best[self.task.completed] = False
        return best


@lru_cache(maxsize=128)
def lesson_task(seed: int, lesson: str, components: int, kind: str, number: int) -> LessonTask:
    """Task `number` of a lesson, of the kind ``shown`` or ``tested``.

    Raises
    ------
    InputError
        `components` lies outside [1, `MOST_COMPONENTS`].
    """
    if not 1 <= components <= MOST_COMPONENTS:
        raise InputError(f"components must lie in [1, {MOST_COMPONENTS}], got {components}")
    names = ("factory lesson", lesson, kind, number)
    random = stream(seed, *names, "factory")
    factory = modified_factory(random)
    task = factory.task(factory.draw_components(random, components))
    return LessonTask(task, task.tables(), feature_codes(features(task), FEATURES), names)
