"""What the types of a life have shown of moves, and the law of the next outcome under each.

In most causes types are alike, in some they differ. For each cause c with counts n_i of type i:

    alike        outcomes of all types have one law: DM(Σ_i n_i)
    apart        each type has its own: Π_i DM(n_i)
    q_c          probability of *apart*, from both and the share ρ of such causes, which is learnt (EM)
    P_i(o | c)   (1 − q_c) (Σ_j n_j + own + b) / … + q_c (n_i + own + b_i) / …

DM is the Dirichlet-multinomial law with pseudo-observations b: α spread over the outcomes that the cause has shown
and one more, and θ of outcomes never shown. Each cause has an α of its own: one that was noisy stays noisy. How
frequent each α is, θ and ρ are learnt for moves and for rewards. b_i is learnt from type i alone.
``own`` are the outcomes of the present task. So a cause that a type has not shown is expected to be as in other
types, as far as causes are usually alike.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.moves import Counts
from lifelore.agent.any_tasks.novelty import log_odds, logsumexp
from lifelore.agent.long_lived.same_type import joined_types, log_evidence

Array = NDArray[np.float64]

MOST_EFFECTS = 12
"""Most outcomes of a cause that are told apart; the rest counts as never shown."""
APART = (0.1, 10.0)
"""Share ρ before anything was seen, and the number of causes that it counts as."""
ALPHAS, THETAS = 2.0 ** np.arange(-5, 4), 2.0 ** np.arange(-6, 4)
"""Values of α and θ that compete."""
NOISE = ALPHAS / ALPHAS.sum()
"""Causes of each α before anything was seen, one in all: a few outcomes alike do not make a law certain."""
ALIKE = -1.0
"""Log odds below which two types are joined: to keep one type as two costs less than to mix two in one."""
ROUNDS = 20
"""Rounds of expectation and maximisation for ρ."""


class KnownMoves:
    """Counts of outcomes by cause, of several types.

    Causes and outcomes are numbered when they are read, so that memories of several robots merge in any order. The
    last effect of each cause stands for all outcomes that no type has shown.

    Parameters
    ----------
    types : sequence of Counts
        Of causes and outcomes, by type.

    Attributes
    ----------
    counts : (n_types, n_causes, n_effects) float64
    broad : (n_causes, n_effects) float64
        The law of a cause of which nothing is known but its outcomes: each as probable, and one more.
    kinds : (n_causes,) int64
        0 where a cause is that of the next state, 1 where it is that of a reward.
    base : (n_causes, n_effects) float64
        The pseudo-observations b.
    own_base : (n_types, n_causes, n_effects) float64
        b as each type alone teaches it: one type is noisy and another is not.
    """

    def __init__(self, types: Sequence[Counts]) -> None:
        self.codes = sorted({cause for one in types for cause, _ in one})
        self._places = {code: place for place, code in enumerate(self.codes)}
        rows: list[Counter[int]] = [Counter() for _ in self.codes]
        for one in types:
            for (cause, outcome), count in one.items():
                rows[self._places[cause]][outcome] += count
        self._effects = [_most(row) for row in rows]
        n_effects = 1 + max((len(row) for row in self._effects), default=0)
        self.counts = np.zeros((len(types), len(self.codes), n_effects))
        for number, one in enumerate(types):
            self.counts[number] = self.own(one, n_effects)
        shown = np.array([len(row) for row in self._effects], np.int64)[:, None]
        known = (np.arange(n_effects) < shown) | (np.arange(n_effects) == n_effects - 1)
        self.broad: Array = known / (shown + 1)
        self.kinds = np.array(self.codes, np.int64) & 1
        self.base: Array = self._base(self.pooled)
        self.own_base: Array = np.array([self._base(one) for one in self.counts])

    def _base(self, counts: Array) -> Array:
        """The pseudo-observations that counts (n_causes, n_effects) teach, of each kind its own."""
        base = self.broad.copy()
        for kind in np.unique(self.kinds).tolist():
            own = self.kinds == kind
            alpha, theta = learnt_base(counts[own], self.broad[own])
            base[own] *= alpha[:, None]
            base[own, -1] += theta
        return base

    @property
    def n_causes(self) -> int:
        """Number of causes."""
        return len(self.codes)

    def place(self, cause: int, outcome: int) -> tuple[int, int] | None:
        """Numbers of a cause and its effect, by their codes; None for a cause that no type has shown."""
        place = self._places.get(cause)
        return None if place is None else (place, self._effects[place].get(outcome, -1))

    def own(self, moves: Counts, n_effects: int | None = None) -> Array:
        """The counts of moves, (n_causes, n_effects); those of unknown causes are left out."""
        counts = np.zeros((self.n_causes, n_effects or self.counts.shape[2]))
        for (cause, outcome), count in moves.items():
            found = self.place(cause, outcome)
            if found is not None:
                counts[found] += count
        return counts

    # ---- laws --------------------------------------------------------------------------------------

    @cached_property
    def pooled(self) -> Array:
        """Counts of all types together, (n_causes, n_effects)."""
        return self.counts.sum(axis=0)

    @cached_property
    def apart(self) -> Array:
        """q, the probability that types differ in a cause, (n_causes,)."""
        evidence = self._log_dm(self.counts).sum(axis=0) - self._log_dm(self.pooled)
        several = (self.counts.any(axis=2)).sum(axis=0) > 1
        found = np.zeros(self.n_causes)
        for kind in np.unique(self.kinds).tolist():
            own = self.kinds == kind
            found[own] = _apart(evidence[own], several[own])
        return found

    @cached_property
    def known_apart(self) -> Array:
        """q of the causes that several types have shown, (n_causes,); 0 in the others."""
        return np.where(self.counts.any(axis=2).sum(axis=0) > 1, self.apart, 0.0)

    @cached_property
    def laws(self) -> Array:
        """P(effect | cause; type) before a task has shown anything, (n_types, n_causes, n_effects)."""
        return self._law(np.arange(self.n_causes), np.zeros(self.base.shape))

    def law(self, cause: int, own: Array) -> Array:
        """P(effect | cause; type), (n_types, n_effects), after the task's own counts (n_effects,) of the cause."""
        return self._law(np.array([cause]), own[None])[:, 0]

    def _law(self, causes: NDArray[np.int64], own: Array) -> Array:
        alike = self.pooled[causes] + own + self.base[causes]
        each = self.counts[:, causes] + own + self.own_base[:, causes]
        q = self.apart[causes, None]
        return (1 - q) * alike / alike.sum(axis=1, keepdims=True) + q * each / each.sum(axis=2, keepdims=True)

    # ---- types that are one, or another -----------------------------------------------------------------

    def evidence_of_another(self, type_: int, moves: Counts) -> float:
        """Log odds that the moves of a task are of a type of its own, and not of a known one."""
        own = self.own(moves)
        alike = self._log_dm(self.pooled + own) - self._log_dm(self.pooled)
        each = self._log_dm(self.counts[type_] + own) - self._log_dm(self.counts[type_])
        known = np.logaddexp(np.log1p(-self.apart) + alike, np.log(self.apart) + each)
        return float(log_odds(self._log_dm(own) - known, self.kinds, self.known_apart))

    def joined(self) -> list[list[int]]:
        """Groups of types that nothing tells apart, by number; each type is in one."""
        return joined_types(self.counts, self.base, self._log_odds, ALIKE)

    def _log_odds(self, evidence: Array) -> Array:
        """Log odds of two types, (n,), from the evidence of causes, (n, n_causes)."""
        return np.array([log_odds(row, self.kinds, self.known_apart) for row in evidence])

    def _log_dm(self, counts: Array) -> Array:
        return log_evidence(counts, self.base)


def _most(row: Mapping[int, float]) -> dict[int, int]:
    """Numbers of the most counted outcomes, in the order of their codes."""
    kept = sorted(row, key=lambda outcome: (-row[outcome], outcome))[:MOST_EFFECTS]
    return {outcome: number for number, outcome in enumerate(sorted(kept))}


def learnt_base(counts: Array, broad: Array) -> tuple[Array, float]:
    """α of each cause, (n_causes,), and θ.

    The weights of α in all causes are those by which the counts are most probable (EM). θ is that by which each
    outcome is best predicted from the others of its cause.

    Parameters
    ----------
    counts, broad : (n_causes, n_effects) float64
        See `KnownMoves`.
    """
    evidence = np.array([log_evidence(counts, alpha * broad) for alpha in ALPHAS])
    total = counts.sum(axis=1, keepdims=True)
    several = total[:, 0] > 1
    belief = np.tile(NOISE[:, None] / NOISE.sum(), len(counts))
    for _ in range(ROUNDS):
        weights = belief[:, several].sum(axis=1) + NOISE
        joint = np.log(weights)[:, None] + evidence
        belief = np.exp(joint - logsumexp(joint, axis=0))
    alpha = np.asarray(ALPHAS @ belief, np.float64)
    left_out, new = np.minimum(counts, 1.0), counts <= 1
    known, others = counts - left_out + alpha[:, None] * broad, total - left_out + alpha[:, None]
    tells = counts * several[:, None]
    scores = [np.sum(tells * np.log((known + theta * new) / (others + theta))) for theta in THETAS]
    return alpha, float(THETAS[np.argmax(scores)])


def _apart(evidence: Array, several: NDArray[np.bool_]) -> Array:
    """q of causes of one kind; `several`: more than one type has shown the cause."""
    share = APART[0]
    for _ in range(ROUNDS):
        found = _sigmoid(evidence + np.log(share / (1 - share)))
        share = (found[several].sum() + APART[0] * APART[1]) / (several.sum() + APART[1])
    return _sigmoid(evidence + np.log(share / (1 - share)))


def _sigmoid(value: Array) -> Array:
    return 1 / (1 + np.exp(-np.clip(value, -20, 20)))
