"""Which type a task has: the belief over the known types, and the alarm that none fits.

The type may change between episodes at a rate h. Each episode may be the first of its type; for each such start r
there is a belief β_r that has seen the episodes from r on and nothing before, with a weight w_r:

    before an episode    w_r ← (1 − h) w_r;   a new start with w = h, whose prior over types is
                         P(j) ∝ Σ_{i≠j} β_i p_j / (1 − p_i): another type than before, drawn from the prior p
    an effect e of k     w_r ← w_r Σ_i β_ri P_ri(e | k), normalised;   every β_r observes it
    belief               β_i = Σ_r w_r β_ri
    the task's counts    of type i: Σ_r P(r | i) c_r, so counts fade as far as the type is believed to be new since

The alarm is that of the likeliest start, since the type has been there from then on. A task has 1 + h (n − 1)
types on the average, so each start may be falsely alarmed as rarely as keeps the task's rate. This is Bayesian
detection of change points (Adams and MacKay, 2007) with types in place of parameters. Where the type stays, h = 0
and there is one start.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.known_types import KnownTypes
from lifelore.agent.long_lived.novelty_alarm import alarm_calibration
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.novelty.calibration import NoveltyCalibration
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector

Array = NDArray[np.float64]

ALARMED = 0.99
"""Least belief in an unknown type after an alarm; the known types then hardly count."""
LEAST_WEIGHT = 1e-6
"""Starts of smaller weight are given up."""
SURE = 1 - 1e-9
"""Largest prior probability of a type, and of an unknown one: there is always another type to change to."""


@dataclass(frozen=True, eq=False)
class Span:
    """Successive episodes of a task in which its type stays.

    Parameters
    ----------
    first : int
        Number of the first of these episodes.
    belief : (n_types + 1,) float64
        At their end.
    alarmed : bool
        Whether no known type fits.
    """

    first: int
    belief: Array
    alarmed: bool


class Recognition:
    """The belief over types in a task; `begin_episode` before every episode.

    Parameters
    ----------
    knowledge : Knowledge
        Read once; what it learns later does not count.
    prior : (n_types,) float
        Over `Knowledge.known_types`.
    false_alarm, unknown, change : float
        As in `LivingSettings`.
    seed : int
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
        change: float = 0.0,
        n_episodes: int = 1,
    ) -> None:
        self.known, self.change = knowledge.known_types(), change
        self._law = with_unknown(prior, unknown)
        self._model: tuple[PolicyLibrary, NoveltyCalibration] | None = None
        # Without a cause that tells types apart, such as after tasks in which nothing was tried, the prior stays.
        if (judged := self.known.judged).size:
            library, share = self.known.library(prior), false_alarm / (1 + change * (n_episodes - 1))
            frequency = knowledge.shared.causes.counts(judged)[:, 0]
            # Twice the usual number of causes: tasks of unknown types try more.
            horizon = max(1, round(2 * frequency.sum() / max(knowledge.n_tasks, 1)))
            generator = stream(seed, "long-lived", "alarm", knowledge.n_tasks)
            calibration = alarm_calibration(library, np.maximum(frequency, 0.5), horizon, share, generator)
            self._model = library, calibration
        self._starts = [_Start(0, self.known, self._model, prior, unknown)]
        self._weight = np.ones(1)
        self._past: list[tuple[Array, list[Span]]] = []
        self._begun = False

    # ---- the task goes on --------------------------------------------------------------------------

    def begin_episode(self) -> None:
        """Begin an episode; at a rate of changes above 0 the type may be another one from here on."""
        if self._begun and self.change:
            self._past.append(self._now())
            prior = self._another(self.belief)
            unknown = float(np.clip(prior[-1], 1 - SURE, SURE))
            known = prior[:-1] / max(float(prior[:-1].sum()), 1e-300)
            if not known.any():  # from the only known type, to none that is known
                known = np.full(len(known), 1 / max(len(known), 1))
            self._starts.append(_Start(len(self._past), self.known, self._model, known, unknown))
            self._weight = np.append((1 - self.change) * self._weight, self.change)
        self._begun = True

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
                predicted = [
                    float(one.belief @ self.known.laws(one.own)[:, cause, effect]) for one in self._starts
                ]
                self._weight = self._weight * predicted
                self._weight /= self._weight.sum()
            for one in self._starts:
                one.observe(cause, effect)
        kept = np.flatnonzero(self._weight >= LEAST_WEIGHT).tolist()
        self._starts = [self._starts[place] for place in kept]
        self._weight = self._weight[kept] / self._weight[kept].sum()

    # ---- what is believed --------------------------------------------------------------------------

    @property
    def belief(self) -> Array:
        """In the known types and, last, in an unknown one, (n_types + 1,)."""
        return np.dot(self._weight, np.array([one.belief for one in self._starts], np.float64))

    @property
    def own(self) -> Array:
        """What the task has shown, (n_causes, n_effects); if types change, of each type as far as it was there."""
        if len(self._starts) == 1:
            return self._starts[0].own
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
        weight, spans = self._now()
        found = [spans[int(weight.argmax())]]
        while found[-1].first:
            weight, spans = self._past[found[-1].first - 1]
            found.append(spans[int(weight.argmax())])
        return found[::-1]

    def _now(self) -> tuple[Array, list[Span]]:
        return self._weight, [Span(one.first, one.belief, one.alarmed) for one in self._starts]


class _Start:
    """The belief over types from some episode on, from which the type stays."""

    def __init__(
        self,
        first: int,
        known: KnownTypes,
        model: tuple[PolicyLibrary, NoveltyCalibration] | None,
        prior: Array,
        unknown: float,
    ) -> None:
        self.first, self.known = first, known
        self.own = np.zeros((known.family.n_causes, known.family.n_effects))
        self.highest = 0.0
        self._judged: set[int] = set()
        self._before = with_unknown(prior, unknown)
        self.agent = None
        if model is not None:
            library, calibration = model
            static = TypeDynamics.static()
            self.alarm = NoveltyDetector(library, unknown, prior, static, calibration=calibration)
            self.agent = BayesianPolicyReuse(library, prior=prior, dynamics=static, novelty=self.alarm)

    @property
    def belief(self) -> Array:
        if self.agent is None:
            return self._before
        return with_unknown(self.agent.belief, max(self.alarm.probability, ALARMED if self.alarm.alarm else 0.0))

    @property
    def alarmed(self) -> bool:
        """Whether the alarm was raised, or no type is known."""
        return len(self.known) == 0 if self.agent is None else self.alarm.alarm

    def observe(self, cause: int, effect: int) -> None:
        """Take in an effect; a cause tells of the type at its first effect alone.

        The same scene answers the same act alike: repeats are no news of the type.
        """
        self.own[cause, effect] += 1
        place = self.known.place_of.get(cause)
        if self.agent is not None and place is not None and cause not in self._judged:
            self._judged.add(cause)
            self.agent.update(place, effect)
            self.highest = max(self.highest, self.alarm.score)


def with_unknown(known: Array, unknown: float) -> Array:
    """A law over known types (n_types,), and an unknown type last; certainly unknown where none is known."""
    return np.append((1 - unknown) * known, unknown) if len(known) else np.ones(1)
