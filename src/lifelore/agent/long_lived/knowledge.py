"""What a long-lived agent knows of a family of tasks, and its form as records of memory.

All of it is counts that add up: effects of causes and sightings for each type, and what all types share. A fleet
can therefore merge them in any order. Types that are alike are joined when knowledge is read, never in memory.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import KIND, ActionPrior
from lifelore.agent.long_lived.known_types import Effects, KnownTypes, effect_counts
from lifelore.agent.long_lived.task_family import SharedKnowledge, TaskFamily
from lifelore.agent.types.type_prior import TypePrior
from lifelore.core.protocols import Record

Array = NDArray[np.float64]

MOST_CONTEXTS = 1 << 20
"""Contexts of tasks are numbered below this."""
LEAST_BELIEF = 0.01
"""Types of less belief learn nothing from a task."""


class TaskNews(NamedTuple):
    """What a task has taught.

    context, date : int
    belief : mapping of str to float
        Belief in each type, by name, at the end of the task: as much does each learn from it.
    effects : sequence of (int, int)
        Causes and effects, in their order.
    contexts, best : (n,) int64, (n, n_acts) bool
        Best acts in the contexts of the task.
    """

    context: int
    date: int
    belief: Mapping[str, float]
    effects: Effects
    contexts: NDArray[np.int64]
    best: NDArray[np.bool_]


class StoredType(NamedTuple):
    """A type that was met.

    effects : counts of effects by cause
    sightings : belief in this type at the end of tasks, by date and context; of a single action
    """

    effects: ActionPrior
    sightings: ActionPrior


@dataclass(eq=False)
class Knowledge:
    """Types by name, and what all types share.

    Parameters
    ----------
    family : TaskFamily
    types : dict of str to StoredType
        By a name that is unique in a fleet: ``"robot.number"``.
    shared : SharedKnowledge
    """

    family: TaskFamily
    types: dict[str, StoredType]
    shared: SharedKnowledge
    _view: KnownTypes | None = field(default=None, repr=False)

    @classmethod
    def empty(cls, family: TaskFamily) -> Self:
        """The knowledge of an agent that has lived through no task."""
        return cls(family, {}, SharedKnowledge.empty(family))

    @property
    def n_tasks(self) -> int:
        """Number of tasks that were lived."""
        return round(float(self.shared.causes.counts([self.family.n_causes])[0, 0]))

    def known_types(self) -> KnownTypes:
        """The types, alike ones joined, in the order of their names."""
        if self._view is None:
            family, names = self.family, sorted(self.types)
            causes = np.arange(family.n_causes)
            rows = np.array([self.types[name].effects.counts(causes) for name in names])
            counts = rows.reshape(len(names), family.n_causes, family.n_effects)
            self._view = KnownTypes.joined(family, names, counts)
        return self._view

    def type_prior(self) -> TypePrior:
        """Which of `known_types` to expect, by context and date."""
        known = self.known_types().types
        return TypePrior.of_types(
            [[_by_when(self.types[name].sightings) for name in one.members] for one in known]
        )

    # ---- learning ----------------------------------------------------------------------------------

    def learn(self, news: TaskNews) -> list[Record]:
        """Learn from a task; return the records by which memory adds it."""
        parts = {name: part for name, part in self._parts(news).items() if len(part)}
        self.add(parts)
        return [
            replace(part.to_record({"family": self.family.name}), key=f"{self.family.name}/{name}")
            for name, part in parts.items()
        ]

    def _parts(self, news: TaskNews) -> dict[str, ActionPrior]:
        family, parts = self.family, dict[str, ActionPrior]()
        code = news.date * MOST_CONTEXTS + news.context
        for name, belief in news.belief.items():
            if belief >= LEAST_BELIEF:
                parts[f"type/{name}"] = effect_counts(family, news.effects, belief)
                parts[f"sightings/{name}"] = _counted([code], [0], 1, belief)
        shown = {cause for cause, _ in news.effects}
        causes = np.array([*sorted(shown), family.n_causes])
        parts["causes"] = _counted(causes, np.zeros_like(causes), 1)
        acts = ActionPrior(len(family.acts))
        acts.update(news.contexts, news.best)
        parts["acts"] = acts
        return parts

    def add(self, parts: Mapping[str, ActionPrior]) -> None:
        """Add counts by the name of their part."""
        for name, part in parts.items():
            kind, _, type_name = name.partition("/")
            if not type_name:
                getattr(self.shared, kind).merge(part)
                continue
            one = self.types.setdefault(type_name, StoredType(ActionPrior(self.family.n_effects), ActionPrior(1)))
            (one.effects if kind == "type" else one.sightings).merge(part)
        self._view = None

    @classmethod
    def from_records(cls, family: TaskFamily, records: Iterable[Record]) -> Self:
        """The knowledge in records of memory; those of other families are left out."""
        made, prefix = cls.empty(family), f"{family.name}/"
        for record in records:
            name = record.key.removeprefix(prefix)
            if record.kind == KIND and name != record.key:
                kind = name.partition("/")[0]
                n = {"type": family.n_effects, "acts": len(family.acts)}.get(kind, 1)
                made.add({name: ActionPrior.from_record(replace(record, key=""), n)})
        return made


def _by_when(sightings: ActionPrior) -> dict[tuple[int, int], float]:
    """Beliefs by date and context."""
    codes = sightings.contexts
    return {
        divmod(code, MOST_CONTEXTS): count
        for code, count in zip(codes.tolist(), sightings.counts(codes)[:, 0], strict=True)
    }


def _counted(codes, results, n: int, weight: float = 1.0) -> ActionPrior:
    counts = ActionPrior(n)
    counts.update_trajectory(codes, results, weight)
    return counts
