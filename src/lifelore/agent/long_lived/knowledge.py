"""What a long-lived agent knows of a family of tasks, and its form as records of memory.

All of it is counts that add up: effects of causes and sightings for each type, and what all types share. A fleet
can therefore merge them in any order. Types that are alike are joined when knowledge is read, never in memory.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import KIND, ActionPrior
from lifelore.agent.long_lived.known_types import Effects, KnownType, KnownTypes, effect_counts, merged_types
from lifelore.agent.long_lived.task_family import SharedKnowledge, TaskFamily
from lifelore.agent.long_lived.type_prior import TypePrior
from lifelore.core.protocols import Record

Array = NDArray[np.float64]

MOST_CONTEXTS = 1 << 20
"""Contexts of tasks are numbered below this."""
LEAST_BELIEF = 0.01
"""Types of less belief learn nothing from a task."""


class SpanNews(NamedTuple):
    """What a span of episodes of one type has taught.

    belief : mapping of str to float
        Belief in each type, by name, at the end of the span: as much does each learn from it.
    effects : sequence of (int, int)
        Causes and effects, in their order.
    """

    belief: Mapping[str, float]
    effects: Effects


@dataclass(frozen=True, eq=False)
class TaskNews:
    """What a task has taught.

    Parameters
    ----------
    context, date : int
    spans : sequence of SpanNews
        At least one; the context's usual types are learnt from the first, with which the task began.
    contexts, best : (n,) int64, (n, n_acts) bool
        Best acts in the contexts of the task.
    """

    context: int
    date: int
    spans: Sequence[SpanNews]
    contexts: NDArray[np.int64]
    best: NDArray[np.bool_]


@dataclass(eq=False)
class Knowledge:
    """Types by name, and what all types share.

    Parameters
    ----------
    family : TaskFamily
    types : dict of str to KnownType
    shared : SharedKnowledge
    """

    family: TaskFamily
    types: dict[str, KnownType]
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
        """The types, alike ones joined, in the order of their names; they follow what is learnt."""
        if self._view is None:
            types = KnownTypes(self.family, [self.types[name] for name in sorted(self.types)])
            self._view = merged_types(types) if len(types) > 1 else types
        return self._view

    def type_prior(self) -> TypePrior:
        """The prior over `known_types` by context and date, learnt from the sightings."""
        n_types = len(self.known_types())
        prior = TypePrior(np.full(n_types, 1 / n_types))
        for (date, context), belief in self.sighted().items():
            prior.count(context, belief, date)
        return prior

    def sighted(self) -> dict[tuple[int, int], Array]:
        """Belief in each of `known_types` at the end of tasks, (n_types,), by date and context in their order."""
        known = self.known_types()
        rows: dict[tuple[int, int], Array] = {}
        for number, one in enumerate(known.types):
            codes = one.sightings.contexts
            for code, count in zip(codes.tolist(), one.sightings.counts(codes)[:, 0], strict=True):
                rows.setdefault(divmod(code, MOST_CONTEXTS), np.zeros(len(known)))[number] += count
        return {key: rows[key] for key in sorted(rows)}

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
        for place, span in enumerate(news.spans):
            for name, belief in span.belief.items():
                if belief < LEAST_BELIEF:
                    continue
                counts, earlier = effect_counts(family, span.effects, belief), parts.get(f"type/{name}")
                parts[f"type/{name}"] = counts if earlier is None else ActionPrior.merged([earlier, counts])
                if not place:
                    parts[f"sightings/{name}"] = _counted([code], [0], 1, belief)
        shown = {cause for span in news.spans for cause, _ in span.effects}
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
            if type_name not in self.types:
                self.types[type_name] = KnownType.empty(self.family, type_name)
                self._view = None
            for one in {id(t): t for t in (self.types[type_name], *self._viewed(type_name))}.values():
                (one.effects if kind == "type" else one.sightings).merge(part)
        if self._view is not None:
            self._view.forget_laws()

    def _viewed(self, name: str) -> list[KnownType]:
        """The joined type that a type belongs to; nothing where it has to be joined again."""
        return [] if self._view is None else [one for one in self._view.types if name in one.members]

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


def _counted(codes, results, n: int, weight: float = 1.0) -> ActionPrior:
    counts = ActionPrior(n)
    counts.update_trajectory(codes, results, weight)
    return counts
