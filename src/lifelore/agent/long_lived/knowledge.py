"""What a long-lived agent knows of a family of tasks, and its form as records of memory."""

from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.long_lived.known_types import Effects, KnownTypes
from lifelore.agent.long_lived.task_family import SharedKnowledge, TaskFamily, record_key
from lifelore.agent.long_lived.type_prior import TypePrior

Array = NDArray[np.float64]

MOST_TYPES = 256
"""Types that a robot can number in memory."""
LEAST_BELIEF = 1e-3
"""Beliefs below this are not remembered."""


@dataclass(eq=False)
class Knowledge:
    """Types, what all types share, and which types came in which context.

    Parameters
    ----------
    family : TaskFamily
    types : KnownTypes
    shared : SharedKnowledge
    sightings : dict of int to ActionPrior
        For each date, how much belief each type had at the end of the tasks of each context.
    causes : (n_causes,) float64
        Number of tasks that showed each cause.
    n_tasks : int
        Number of tasks that were lived.
    """

    family: TaskFamily
    types: KnownTypes
    shared: SharedKnowledge
    sightings: dict[int, ActionPrior] = field(default_factory=dict)
    causes: Array = field(default_factory=lambda: np.zeros(0))
    n_tasks: int = 0

    @classmethod
    def empty(cls, family: TaskFamily) -> Self:
        """The knowledge of an agent that has lived through no task."""
        name = family.name
        shared = SharedKnowledge(
            ActionPrior(family.n_results, key=record_key(name, "moves")),
            ActionPrior(len(family.acts), key=record_key(name, "acts")),
        )
        return cls(family, KnownTypes(family), shared, {}, np.zeros(family.n_causes))

    # ---- reading -----------------------------------------------------------------------------------

    def type_prior(self) -> TypePrior:
        """The prior over the types by context and date, learnt from the sightings."""
        n_types = len(self.types)
        prior = TypePrior(np.full(n_types, 1 / n_types), key=record_key(self.family.name, "sightings"))
        for date, counts in self.sightings.items():
            contexts = counts.contexts
            rows = counts.counts(contexts)[:, :n_types]
            for context, row in zip(contexts.tolist(), rows, strict=True):
                prior.count(context, row, date)
        return prior

    # ---- learning ----------------------------------------------------------------------------------

    def sight(self, context: int, belief: Array, date: int) -> None:
        """Remember the belief over types (n_types,) at the end of a task."""
        held = np.flatnonzero(belief >= LEAST_BELIEF)
        if date not in self.sightings:
            self.sightings[date] = ActionPrior(MOST_TYPES, key=record_key(self.family.name, "sightings"))
        best = np.zeros((len(held), MOST_TYPES), np.bool_)
        best[np.arange(len(held)), held] = True
        self.sightings[date].update(np.full(len(held), context), best, belief[held])

    def count_causes(self, effects: Effects) -> None:
        """Count a task, and the causes that it showed."""
        self.causes[list({cause for cause, _ in effects})] += 1
        self.n_tasks += 1
