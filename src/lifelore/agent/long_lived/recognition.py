"""Which type a task has: the belief over the known types, and the alarm that none fits."""

from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.known_types import KnownTypes
from lifelore.agent.long_lived.novelty_alarm import N_TASKS, calibrated_alarm
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.novelty.calibration import LEAST_ALARMS
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector

Array = NDArray[np.float64]

ALARMED = 0.99
"""Least belief in an unknown type after an alarm; the known types then hardly count."""


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


class Belief(Protocol):
    """What decisions rest on: the known types, what the task has shown, and the belief over its type.

    known : KnownTypes
    own : (n_causes, n_effects) float64, or with a row for each type where types change within the task
    belief : (n_types + 1,) float64
        In the known types and, last, in an unknown one.
    """

    @property
    def known(self) -> KnownTypes: ...

    @property
    def own(self) -> Array: ...

    @property
    def belief(self) -> Array: ...


class Recognition:
    """The belief over types in a task whose type stays.

    Parameters
    ----------
    knowledge : Knowledge
        Read once; what it learns later does not count.
    prior : (n_types,) float
        Over `Knowledge.known_types`.
    false_alarm, unknown : float
        As in `LivingSettings`.
    seed : int

    Attributes
    ----------
    own : (n_causes, n_effects) float64
        What the task has shown.
    highest : float
        Largest score of the alarm's detector so far.
    """

    def __init__(self, knowledge: Knowledge, prior: Array, false_alarm: float, unknown: float, seed: int) -> None:
        self.known = knowledge.known_types()
        self.agent: BayesianPolicyReuse | None = None
        self.alarm: NoveltyDetector | None = None
        self._place: dict[int, int] = {}
        self._before = with_unknown(prior, unknown)
        # Without a cause that tells types apart, such as after tasks in which nothing was tried, the prior stays.
        if (judged := self.known.judged).size:
            library = self.known.library(prior)
            self._place = {int(cause): place for place, cause in enumerate(judged)}
            frequency = knowledge.shared.causes.counts(judged)[:, 0]
            self.alarm = calibrated_alarm(
                library,
                np.maximum(frequency, 0.5),
                # Twice the usual number of causes: tasks of unknown types try more.
                max(1, round(2 * frequency.sum() / max(knowledge.n_tasks, 1))),
                false_alarm,
                stream(seed, "long-lived", "alarm", knowledge.n_tasks),
                unknown,
                max(N_TASKS, int(np.ceil(LEAST_ALARMS / false_alarm))),
            )
            self.agent = BayesianPolicyReuse(library, dynamics=TypeDynamics.static(), novelty=self.alarm)
        self._forget_task()

    def _forget_task(self) -> None:
        family = self.known.family
        self.own = np.zeros((family.n_causes, family.n_effects))
        self.highest = 0.0
        self._judged: set[int] = set()

    def restarted(self, prior: Array, unknown: float) -> Self:
        """Another task's recognition, with the same laws and the same threshold of the alarm."""
        other = type(self).__new__(type(self))
        other.known, other.agent, other.alarm, other._place = self.known, None, None, self._place
        other._before = with_unknown(prior, unknown)
        if self.agent is not None and self.alarm is not None:
            library = self.agent.library
            static = TypeDynamics.static()
            other.alarm = NoveltyDetector(library, unknown, prior, static, calibration=self.alarm.calibration)
            other.agent = BayesianPolicyReuse(library, prior=prior, dynamics=static, novelty=other.alarm)
        other._forget_task()
        return other

    @property
    def belief(self) -> Array:
        """In the known types and, last, in an unknown one, (n_types + 1,)."""
        if self.agent is None or self.alarm is None:
            return self._before
        return with_unknown(self.agent.belief, max(self.alarm.probability, ALARMED if self.alarm.alarm else 0.0))

    def begin_episode(self) -> None:
        """Begin an episode; the type stays."""

    def observe(self, effects: tuple[tuple[int, int], ...]) -> None:
        """Take in the effects of an act; a cause tells of the type at its first effect alone.

        The same scene answers the same act alike: repeats are no news of the type.
        """
        for cause, effect in effects:
            self.own[cause, effect] += 1
            if self.agent is None or self.alarm is None or cause not in self._place:
                continue
            if cause in self._judged:
                continue
            self._judged.add(cause)
            self.agent.update(self._place[cause], effect)
            self.highest = max(self.highest, self.alarm.score)

    @property
    def alarmed(self) -> bool:
        """Whether the alarm was raised, or no type is known."""
        return len(self.known) == 0 if self.alarm is None else self.alarm.alarm

    def spans(self) -> list[Span]:
        """The whole task."""
        return [Span(0, self.belief, self.alarmed)]


def with_unknown(known: Array, unknown: float) -> Array:
    """A law over known types (n_types,), and an unknown type last; certainly unknown where none is known."""
    return np.append((1 - unknown) * known, unknown) if len(known) else np.ones(1)
