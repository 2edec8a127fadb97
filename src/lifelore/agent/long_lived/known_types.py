"""The types that the agent has met in a family, and the laws by which it plans.

The law of a cause under type i, after the counts c of the present task:

    P_i(e) ∝ s type_i(e) + c(e),   type_i from `TypeCounts`, s from the family (`TaskFamily.constancy`)

What is known of a cause before it was tried is the law of its group. An unknown type has shown nothing: where
known types are alike it is as they are, elsewhere it may be anything.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.long_lived.task_family import TaskFamily
from lifelore.agent.types.same_type import JoinedType
from lifelore.agent.types.type_counts import ALPHAS, TypeCounts, Usual

Array = NDArray[np.float64]
Effects = Sequence[tuple[int, int]]

FIRST = 0.5
"""Weight of what a family calls possible beside the effects of a group, in observations."""
USUAL = Usual(0.9, 4.0, 1 / ALPHAS / np.sum(1 / ALPHAS))
"""Types often differ in what a family calls a cause, and the same scene mostly answers alike."""
ANOTHER = 0.2
"""Log odds from which a task has a type of its own: where it shows next to nothing, it has a known one."""
APART = 0.0
"""Log odds from which two types stay apart: types without a common cause are one."""


def effect_counts(family: TaskFamily, effects: Effects, weight: float = 1.0) -> ActionPrior:
    """Counts of the effects of a task; each cause counts `weight`, whatever its number of repeats.

    The episodes of a task are not independent: the same scene answers the same act alike.
    """
    counts = ActionPrior(family.n_effects)
    if effects:
        causes, found = np.array(effects, np.int64).T
        _, place, repeats = np.unique(causes, return_inverse=True, return_counts=True)
        best = np.zeros((len(causes), counts.n_actions), np.bool_)
        best[np.arange(len(causes)), found] = True
        counts.update(causes, best, weight / repeats[place])
    return counts


def group_laws(family: TaskFamily, counts: Array) -> Array:
    """The law of each cause as the others of its group tell it, from (n_causes, n_effects) counts of all types."""
    groups = np.zeros((family.groups.max() + 1, family.n_effects))
    np.add.at(groups, family.groups, counts)
    found = np.maximum(groups[family.groups] - counts, 0.0) + FIRST * family.possible
    return found / found.sum(axis=1, keepdims=True)


class KnownTypes:
    """The known types of a family, and the laws of their effects.

    Parameters
    ----------
    family : TaskFamily
    types : list of JoinedType
    counts : (n_types, n_causes, n_effects) float
        Of effects, as counted.

    Attributes
    ----------
    judged : (n_judged,) int64
        The causes that were tried and tell types apart, ascending.
    """

    def __init__(self, family: TaskFamily, types: list[JoinedType], counts: Array) -> None:
        self.family, self.types, self.counts = family, types, family.smoothed(counts)
        self.broad = group_laws(family, self.counts.sum(axis=0))
        self.judged = np.flatnonzero(self.counts.any(axis=(0, 2)) & family.judges)

    @classmethod
    def joined(cls, family: TaskFamily, names: Sequence[str], counts: Array) -> Self:
        """The types of some names, those joined that nothing tells apart; memory keeps each type's own counts."""
        apart = cls(family, [JoinedType((name,)) for name in names], counts)
        groups = apart.telling.joined(APART)
        if len(groups) == len(names):
            return apart
        types = [JoinedType(tuple(names[number] for number in group)) for group in groups]
        return cls(family, types, np.stack([counts[group].sum(axis=0) for group in groups]))

    def __len__(self) -> int:
        return len(self.types)

    @cached_property
    def all(self) -> TypeCounts:
        """What the types and, last, an unknown one have shown, of all causes."""
        rows = np.concatenate([self.counts, np.zeros((1, *self.broad.shape))])
        return TypeCounts(rows, self.broad, self.family.kinds, USUAL)

    @cached_property
    def telling(self) -> TypeCounts:
        """What the types have shown of the judged causes, in their order."""
        judged = self.judged
        return TypeCounts(self.counts[:, judged], self.broad[judged], self.family.kinds[judged], USUAL)

    @cached_property
    def place_of(self) -> dict[int, int]:
        """Place of each judged cause among them."""
        return {cause: place for place, cause in enumerate(self.judged.tolist())}

    def tried(self, own: Array) -> NDArray[np.bool_]:
        """(n_causes,) whether anything is known of each cause or its group, after the task's own counts."""
        seen = self.counts.any(axis=(0, 2)) | own.any(axis=1)
        groups = self.family.groups
        return np.isin(groups, groups[seen])

    def laws(self, own: Array, generator: np.random.Generator | None = None) -> Array:
        """P(effect | cause), (n_types + 1, n_causes, n_effects), after the task's `own` counts.

        The last row is of an unknown type. With a generator, laws are drawn from what the counts leave possible.
        """
        rows = self.all.laws if generator is None else self.all.drawn_laws(generator)
        rows = rows * self.family.constancy[:, None] + self.family.smoothed(own[None])
        if generator is not None:
            rows = generator.standard_gamma(rows) + 1e-12 * rows
        return rows / rows.sum(axis=2, keepdims=True)

    def differs(self, number: int, effects: Effects) -> bool:
        """Whether a task is probably of a type of its own, and not of a known one, by its effects."""
        own = effect_counts(self.family, effects).counts(np.arange(self.family.n_causes))
        own = self.family.smoothed(own[None])[0, self.judged]
        return self.telling.evidence_of_another(number, own) > ANOTHER
