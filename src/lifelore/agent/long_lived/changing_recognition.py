"""The belief over types in a task whose type may change between episodes: it follows.

Each episode may be the first of its type. For each such start r there is a `Recognition` that has seen the
episodes from r on and nothing before, with a weight w_r:

    before an episode    w_r ← (1 − h) w_r;   a new start with w = h, whose prior over types is
                         P(j) ∝ Σ_{i≠j} β_i p_j / (1 − p_i): another type than before, drawn from the prior p
    an effect e of k     w_r ← w_r Σ_i β_ri P_ri(e | k), normalised;   every Recognition observes it
    belief               β_i = Σ_r w_r β_ri
    the task's counts    of type i: Σ_r P(r | i) c_r, so counts fade as far as the type is believed to be new since

The alarm is that of the likeliest start, since the type has been there from then on. A task has 1 + h (n − 1)
types on the average, so each start may be falsely alarmed as rarely as keeps the task's rate. This is Bayesian
detection of change points (Adams and MacKay, 2007) with types in place of parameters.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.recognition import Recognition, Span, with_unknown

Array = NDArray[np.float64]

LEAST_WEIGHT = 1e-6
"""Starts of smaller weight are given up."""
SURE = 1 - 1e-9
"""Largest prior probability of a type, and of an unknown one: there is always another type to change to."""


class _Past(NamedTuple):
    """The starts at the end of an episode: first episodes, weights, beliefs, and whether each was alarmed."""

    first: list[int]
    weight: Array
    belief: Array
    alarmed: list[bool]


class ChangingRecognition:
    """See `Recognition`; `begin_episode` before every episode.

    Parameters
    ----------
    knowledge, prior, false_alarm, unknown, seed
        As for `Recognition`; the rate of false alarms is that of the whole task.
    change : float
        Probability h that the type changes between two episodes, in (0, 1).
    n_episodes : int
        Of the task.
    """

    def __init__(
        self,
        knowledge: Knowledge,
        prior: Array,
        false_alarm: float,
        unknown: float,
        seed: int,
        change: float,
        n_episodes: int,
    ) -> None:
        share = false_alarm / (1 + change * (n_episodes - 1))
        self.known, self.change = knowledge.known_types(), change
        self._law = with_unknown(prior, unknown)
        self._starts = [Recognition(knowledge, prior, share, unknown, seed)]
        self._first, self._weight = [0], np.ones(1)
        self._past: list[_Past] = []
        self._n_begun = 0

    # ---- the task goes on --------------------------------------------------------------------------

    def begin_episode(self) -> None:
        """Begin an episode; the type may be another one from here on."""
        if self._n_begun:
            self._past.append(self._now())
            prior = self._another(self.belief)
            unknown = float(np.clip(prior[-1], 1 - SURE, SURE))
            known = prior[:-1] / max(float(prior[:-1].sum()), 1e-300)
            if not known.any():  # from the only known type, to none that is known
                known = np.full(len(known), 1 / max(len(known), 1))
            self._starts.append(self._starts[0].restarted(known, unknown))
            self._first.append(self._n_begun)
            self._weight = np.append((1 - self.change) * self._weight, self.change)
        self._n_begun += 1

    def _another(self, belief: Array) -> Array:
        """Law of the next type, given that it is another than the last, (n_types + 1,)."""
        if len(belief) == 1:
            return belief
        # An unknown type may be followed by another unknown one.
        share = belief / (1 - np.minimum(np.append(self._law[:-1], 0.0), SURE))
        following = self._law * (share.sum() - np.append(share[:-1], 0.0))
        return following / following.sum()

    def observe(self, effects: tuple[tuple[int, int], ...]) -> None:
        """Take in the effects of an act."""
        for cause, effect in effects:
            if len(self._starts) > 1:
                predicted = [float(one.belief @ one.known.laws(one.own)[:, cause, effect]) for one in self._starts]
                self._weight = self._weight * predicted
                self._weight /= self._weight.sum()
            for one in self._starts:
                one.observe(((cause, effect),))
        kept = np.flatnonzero(self._weight >= LEAST_WEIGHT).tolist()
        self._starts = [self._starts[place] for place in kept]
        self._first = [self._first[place] for place in kept]
        self._weight = self._weight[kept] / self._weight[kept].sum()

    # ---- what is believed --------------------------------------------------------------------------

    @property
    def belief(self) -> Array:
        """In the known types and, last, in an unknown one, (n_types + 1,)."""
        beliefs: Array = np.array([one.belief for one in self._starts], np.float64)
        return np.dot(self._weight, beliefs)

    @property
    def own(self) -> Array:
        """What the task has shown of each type, as far as it was there, (n_types + 1, n_causes, n_effects)."""
        beliefs = np.array([one.belief for one in self._starts]) + 1e-12
        joint = self._weight[:, None] * beliefs
        return np.einsum("ri,rce->ice", joint / joint.sum(axis=0), np.array([one.own for one in self._starts]))

    @property
    def alarmed(self) -> bool:
        """Whether no known type fits some span of the task."""
        return any(span.alarmed for span in self.spans())

    @property
    def highest(self) -> float:
        """Largest score of the detector since the likeliest start."""
        return self._starts[int(self._weight.argmax())].highest

    def spans(self) -> list[Span]:
        """The likeliest spans of one type, in their order: from the last start to the one before, and so on."""
        now, found = self._now(), list[Span]()
        while True:
            place = int(now.weight.argmax())
            first = now.first[place]
            found.append(Span(first, now.belief[place], now.alarmed[place]))
            if not first:
                return found[::-1]
            now = self._past[first - 1]

    def _now(self) -> _Past:
        beliefs = np.array([one.belief for one in self._starts])
        return _Past(list(self._first), self._weight, beliefs, [one.alarmed for one in self._starts])
