"""The types that the agent has met: counts of effects by cause, for each; additive, so that fleets can share them.

The law of a cause under type i, after the counts c of the present task:

    group(e)  ∝ Σ_j n_j(e), over the other causes of the group, + α p₀(e)
    pooled(e) ∝ Σ_j n_j(e) + α group(e)
    type_i(e) ∝ n_i(e) + κ pooled(e)
    P_i(e)    ∝ s type_i(e) + c(e), s from the family (`TaskFamily.constancy`), κ and α from `concentrations`

An unknown type has n = 0 and, instead of pooled, (1 − η) pooled + η p₀: it mostly behaves as types usually do,
until its own task shows otherwise.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.long_lived.concentrations import Concentrations, group_laws, learnt_concentrations
from lifelore.agent.long_lived.task_family import TaskFamily
from lifelore.agent.types.same_type import JoinedType, joined_types, log_evidence
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.signals.category_signal import CategorySignal

Array = NDArray[np.float64]
Effects = Sequence[tuple[int, int]]

TELLING = 2.5
"""Evidence in nats by which a single cause tells two types apart; more joins types that differ."""
NEW = 0.3
"""Share of what a family calls possible in the law of an unknown type: it may differ from all known ones."""


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


class KnownTypes:
    """The known types of a family, and the laws of their effects.

    Parameters
    ----------
    family : TaskFamily
    types : list of JoinedType
    counts : (n_types, n_causes, n_effects) float
        Of effects, as counted.
    """

    def __init__(self, family: TaskFamily, types: list[JoinedType], counts: Array) -> None:
        self.family, self.types, self._counted = family, types, counts

    @classmethod
    def joined(cls, family: TaskFamily, names: Sequence[str], counts: Array) -> Self:
        """The types of some names, those joined that nothing tells apart; memory keeps each type's own counts."""
        apart = cls(family, [JoinedType((name,)) for name in names], counts)
        judges = family.judges
        # Evidence 0: types without a common cause.
        groups = joined_types(apart.counts[:, judges], apart._base[judges], evidence_for_two, 0.0)
        if len(groups) == len(names):
            return apart
        types = [JoinedType(tuple(names[number] for number in group)) for group in groups]
        return cls(family, types, np.stack([counts[group].sum(axis=0) for group in groups]))

    def __len__(self) -> int:
        return len(self.types)

    @cached_property
    def counts(self) -> Array:
        """(n_types, n_causes, n_effects) counts, after `TaskFamily.smoothed`."""
        return self.family.smoothed(self._counted)

    @cached_property
    def concentrations(self) -> Concentrations:
        """How much the types differ."""
        return learnt_concentrations(self.family, self._counted, self.counts)

    @cached_property
    def pooled(self) -> Array:
        """(n_causes, n_effects) the law that all types have in common."""
        counts, alpha = self.counts.sum(axis=0), self.concentrations.alpha
        total = counts + alpha[:, None] * group_laws(self.family, counts, alpha)
        return total / total.sum(axis=1, keepdims=True)

    @cached_property
    def _base(self) -> Array:
        """What each cause's law adds to counts, in observations, (n_causes, n_effects)."""
        return self.concentrations.kappa[:, None] * self.pooled

    def tried(self, own: Array) -> NDArray[np.bool_]:
        """(n_causes,) whether anything is known of each cause or its group, after the task's own counts."""
        seen = self.counts.any(axis=(0, 2)) | own.any(axis=1)
        groups = self.family.groups
        return np.isin(groups, groups[seen])

    def laws(self, own: Array, generator: np.random.Generator | None = None) -> Array:
        """P(effect | cause), (n_types + 1, n_causes, n_effects), after the task's `own` counts.

        The last row is of an unknown type. With a generator, laws are drawn from what the counts leave possible.
        """
        unknown = NEW * self.concentrations.kappa[:, None] * (self.family.possible - self.pooled)
        rows = np.concatenate([self.counts, unknown[None]])
        rows += self._base
        if generator is not None:
            rows = _drawn(rows, generator)
        rows *= self.family.constancy[:, None] / rows.sum(axis=2, keepdims=True)
        rows += self.family.smoothed(own[None])
        if generator is not None:
            rows = _drawn(rows, generator)
        return rows / rows.sum(axis=2, keepdims=True)

    def differs(self, number: int, effects: Effects) -> bool:
        """Whether the effects of a task are better explained by a type of its own than by a known one."""
        judges = self.family.judges
        own = effect_counts(self.family, effects).counts(np.arange(self.family.n_causes))
        own = self.family.smoothed(own[None])[0, judges]
        known, base = self.counts[number, judges], self._base[judges]
        evidence = log_evidence(known, base) + log_evidence(own, base) - log_evidence(known + own, base)
        return bool(evidence_for_two(evidence) > 0)

    @cached_property
    def judged(self) -> NDArray[np.int64]:
        """The causes that were tried and tell types apart, ascending."""
        return np.flatnonzero(self.counts.any(axis=(0, 2)) & self.family.judges)

    @cached_property
    def place_of(self) -> dict[int, int]:
        """Place of each judged cause among them."""
        return {cause: place for place, cause in enumerate(self.judged.tolist())}

    def library(self, prior: Array) -> PolicyLibrary:
        """A library whose policies are the judged causes, and whose signals are their effects."""
        rows = self.counts[:, self.judged] + self._base[self.judged]
        count = rows.sum(axis=2)
        signal = CategorySignal(rows / count[:, :, None], count=count)
        performance = GaussianOutcomes(np.zeros((len(self), len(self.judged))), 1.0)
        return PolicyLibrary(performance, signal, tuple(known.name for known in self.types), prior=prior)


def _drawn(counts: Array, generator: np.random.Generator) -> Array:
    """Gammas of the counts; a row in proportion is a draw of its Dirichlet law."""
    return generator.standard_gamma(counts) + 1e-12 * counts


def evidence_for_two(evidence: Array) -> Array:
    """Evidence in nats that counts have two laws and not one, (...), from that of each cause, (..., n_causes).

    It is that of all causes together, and infinite where a single cause gives more than `TELLING`: types may agree
    in nearly all they do.
    """
    return np.where(evidence.max(axis=-1, initial=0.0) > TELLING, np.inf, evidence.sum(axis=-1))
