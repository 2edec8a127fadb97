"""What the types of a life have shown of moves, and the law of the next outcome of a cause under each.

In most causes types are alike, in some they differ. For each cause c with counts n_i of type i:

    alike        outcomes of all types have one law: DM(Σ_i n_i)
    apart        each type has its own: Π_i DM(n_i)
    q_c          probability of *apart*, from both and the share ρ of such causes, which is learnt (EM)
    P_i(o | c)   (1 − q_c) (Σ_j n_j + own + b) / … + q_c (n_i + own + b_i) / …

DM is the Dirichlet-multinomial law with pseudo-observations b: α spread over the outcomes that the cause may have,
and θ of outcomes never shown. Each cause has an α of its own: one that was noisy within types stays noisy. How
frequent each α is, θ and ρ are learnt for each kind of cause. b_i is learnt from type i, beginning with what all
types teach. ``own`` are the outcomes of the present task. So a cause that a type has not shown is expected to be
as in other types, as far as causes are usually alike.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.moves import Counts
from lifelore.agent.types.novelty import NoveltyAlarm, log_odds, logsumexp
from lifelore.agent.types.same_type import joined_types, log_evidence

Array = NDArray[np.float64]

MOST_EFFECTS = 12
"""Most outcomes of a cause that are told apart; the rest counts as never shown."""
ALPHAS, THETAS = 2.0 ** np.arange(-5, 4), 2.0 ** np.arange(-6, 4)
"""Values of α and θ that compete."""
ALIKE = -1.0
"""Log odds below which two types are joined: to keep one type as two costs less than to mix two in one."""
ROUNDS = 20
"""Rounds of expectation and maximisation."""
SHARE, WEIGHT, NOISE = 0.1, 10.0, ALPHAS / ALPHAS.sum()
"""Expected before anything was seen: ρ, causes that ρ counts as, and causes of each α. Types mostly agree in what
a move does, and a few outcomes alike do not make a law certain."""
NEAR = 1e-9
"""Distance of q from 0 and 1."""


class KnownMoves:
    """Counts of outcomes by cause, of several types.

    Causes and outcomes are numbered when they are read, so that memories of several robots merge in any order. The
    last effect of each cause stands for all outcomes that no type has shown: a cause of which nothing is known but
    its outcomes has each with the same probability, and one more. Types differ about as often, and outcomes are
    about as noisy, in all causes of a kind: 0 is that of the next state, 1 that of a reward.

    Parameters
    ----------
    types : sequence of Counts
        Of causes and outcomes, by type.

    Attributes
    ----------
    counts : (n_types, n_causes, n_effects) float64
    broad : (n_causes, n_effects) float64
        The law of a cause of which nothing is known.
    kinds : (n_causes,) int64
    base : (n_causes, n_effects) float64
        The pseudo-observations b.
    own_base : (n_types, n_causes, n_effects) float64
        b as each type alone teaches it: one type is noisy and another is not.
    apart : (n_causes,) float64
        q, the probability that types differ in a cause.
    """

    def __init__(self, types: Sequence[Counts]) -> None:
        self.codes = sorted({cause for one in types for cause, _ in one})
        self._places = {code: place for place, code in enumerate(self.codes)}
        rows: list[Counter[int]] = [Counter() for _ in self.codes]
        for one in types:
            for (cause, outcome), count in one.items():
                rows[self._places[cause]][outcome] += count
        self._effects = [_most(row) for row in rows]
        shown = np.array([len(row) for row in self._effects], np.int64)[:, None]
        effects = np.arange(1 + max(shown.max(initial=0), 0))
        known = (effects < shown) | (effects == effects[-1])
        self.broad: Array = known / (shown + 1)
        self.counts = np.array([self.own(one) for one in types]).reshape(len(types), *known.shape)
        self.kinds = np.array(self.codes, np.int64) & 1
        self.base, self.own_base = self.broad.copy(), np.tile(self.broad, (len(types), 1, 1))
        self.apart: Array = np.zeros(len(self.codes))
        self._learn_laws()

    def _learn_laws(self) -> None:
        """Learn b and q."""
        alike = np.array([log_evidence(self.pooled, alpha * self.broad) for alpha in ALPHAS])
        each = np.array([log_evidence(self.counts, alpha * self.broad) for alpha in ALPHAS])
        apart = each.sum(axis=1)
        for kind in np.unique(self.kinds).tolist():
            own = self.kinds == kind
            several, often = self._several[own], self.pooled[own].sum(axis=1) > 1
            self.apart[own], noise = learnt_apart(alike[:, own], apart[:, own], several, often)
            _add_noise(self.base, self.pooled, own, apart, noise)
            for number, base in enumerate(self.own_base):
                _add_noise(base, self.counts[number], own, each[:, number], noise)

    def place(self, cause: int, outcome: int) -> tuple[int, int] | None:
        """Numbers of a cause and its effect, by their codes; None for a cause that no type has shown."""
        place = self._places.get(cause)
        return None if place is None else (place, self._effects[place].get(outcome, -1))

    def own(self, moves: Counts) -> Array:
        """The counts of moves, (n_causes, n_effects); those of unknown causes are left out."""
        counts = np.zeros(self.broad.shape)
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
    def _several(self) -> NDArray[np.bool_]:
        """(n_causes,) whether more than one type has shown a cause."""
        return self.counts.any(axis=2).sum(axis=0) > 1

    @cached_property
    def known_apart(self) -> Array:
        """q of the causes that several types have shown, (n_causes,); 0 in the others."""
        return np.where(self._several, self.apart, 0.0)

    @cached_property
    def laws(self) -> Array:
        """P(effect | cause; type) before a task has shown anything, (n_types, n_causes, n_effects)."""
        return self._law(np.arange(len(self.codes)), np.zeros(self.base.shape))

    def law(self, cause: int, own: Array) -> Array:
        """P(effect | cause; type), (n_types, n_effects), after the task's own counts (n_effects,) of the cause."""
        return self._law(np.array([cause]), own[None])[:, 0]

    def _law(self, causes: NDArray[np.int64], own: Array) -> Array:
        alike = self.pooled[causes] + own + self.base[causes]
        each = self.counts[:, causes] + own + self.own_base[:, causes]
        q = self.apart[causes, None]
        return (1 - q) * alike / alike.sum(axis=1, keepdims=True) + q * each / each.sum(axis=2, keepdims=True)

    # ---- types that are one, or another -----------------------------------------------------------------

    def alarm(
        self, prior: Array, frequency: Array, n_tasks: int, false_alarm: float, generator: np.random.Generator
    ) -> NoveltyAlarm:
        """The alarm of a task that no type fits.

        Parameters
        ----------
        prior : (n_types,) float
        frequency : (n_causes,) float
            Number of the `n_tasks` earlier tasks that showed each cause.
        false_alarm : float
            Probability of an alarm in a task of a known type, in (0, 1).
        """
        # Twice the usual number of causes: tasks of unknown types try more.
        horizon = 2 * frequency.sum() / max(n_tasks, 1)
        return NoveltyAlarm(
            self.laws, self.broad, self.kinds, self.known_apart, prior, frequency, horizon, false_alarm, generator
        )

    def evidence_of_another(self, type_: int, own: Array) -> float:
        """Log odds that a task's counts (n_causes, n_effects) are of a type of its own, and not of a known one."""
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


def learnt_apart(
    alike: Array, apart: Array, several: NDArray[np.bool_], often: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """q of causes of one kind, (n_causes,), and how frequent each α is, (n_alphas,), one in all.

    Parameters
    ----------
    alike, apart : (n_alphas, n_causes) float
        Log probability of a cause's counts, if all types have one law and if each has its own.
    several, often : (n_causes,) bool
        Causes that more than one type has shown, and those with more than one outcome: others tell nothing of ρ,
        or of α.
    """
    share, noise, q = SHARE, NOISE, np.zeros(alike.shape[1])
    for _ in range(ROUNDS):
        joint = np.array([np.log(1 - share) + alike, np.log(share) + apart]) + np.log(noise / noise.sum())[:, None]
        belief = np.exp(joint - logsumexp(logsumexp(joint, axis=0), axis=0))
        q = belief[1].sum(axis=0)
        noise = belief.sum(axis=0)[:, often].sum(axis=1) + NOISE
        share = (q[several].sum() + SHARE * WEIGHT) / (several.sum() + WEIGHT)
    return np.clip(q, NEAR, 1 - NEAR), noise / noise.sum()


def _add_noise(base: Array, counts: Array, own: NDArray[np.bool_], evidence: Array, noise: Array) -> None:
    """Make pseudo-observations of the laws `base` of a kind's causes, `own`; the rest as of `KnownMoves`."""
    base[own] *= learnt_noise(evidence[:, own], counts[own].sum(axis=1) > 1, noise)[:, None]
    base[own, -1] += learnt_rest(counts[own], base[own])


def learnt_noise(evidence: Array, often: NDArray[np.bool_], usual: Array) -> Array:
    """α of each cause of one kind, (n_causes,): the geometric mean, by how probable each α is (EM).

    Parameters
    ----------
    evidence : (n_alphas, n_causes) float
        Log probability of a cause's counts.
    often : (n_causes,) bool
        Causes with more than one outcome.
    usual : (n_alphas,) float
        Causes of each α before anything was seen.
    """
    belief = np.tile(usual[:, None] / usual.sum(), evidence.shape[1])
    for _ in range(ROUNDS):
        weights = belief[:, often].sum(axis=1) + usual
        joint = np.log(weights)[:, None] + evidence
        belief = np.exp(joint - logsumexp(joint, axis=0))
    return np.exp(np.log(ALPHAS) @ belief)


def learnt_rest(counts: Array, base: Array) -> float:
    """θ by which each outcome of (n_causes, n_effects) counts is best predicted from the others of its cause."""
    total, all_base = counts.sum(axis=1, keepdims=True), base.sum(axis=1, keepdims=True)
    left_out, new = np.minimum(counts, 1.0), counts <= 1
    known, others = counts - left_out + base, total - left_out + all_base
    tells = counts * (total > 1)
    scores = [np.sum(tells * np.log((known + theta * new) / (others + theta))) for theta in THETAS]
    return float(THETAS[np.argmax(scores)])


def _most(row: Mapping[int, float]) -> dict[int, int]:
    """Numbers of the most counted outcomes, in the order of their codes."""
    kept = sorted(row, key=lambda outcome: (-row[outcome], outcome))[:MOST_EFFECTS]
    return {outcome: number for number, outcome in enumerate(sorted(kept))}
