"""Which type a task has: the belief over the known types, and the alarm that none fits."""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.types.novelty import NoveltyAlarm
from lifelore.core.streams import stream

Array = NDArray[np.float64]

UNKNOWN = 0.05
"""Prior probability that no known type fits."""
ALARMED = 0.99
"""Least belief in an unknown type after an alarm; the known types then hardly count."""


class Recognition:
    """The belief over types in a task.

    Parameters
    ----------
    knowledge : Knowledge
        Read once; what it learns later does not count.
    prior : (n_types,) float
        Over `Knowledge.known_types`.
    false_alarm : float
        Probability of an alarm in a task of a known type, in (0, 1).
    seed : int

    Attributes
    ----------
    own : (n_causes, n_effects) float64
        Counts of what the task has shown.
    highest : float
        Largest log odds of an unknown type.
    """

    def __init__(self, knowledge: Knowledge, prior: Array, false_alarm: float, seed: int) -> None:
        self.known, family = knowledge.known_types(), knowledge.family
        self.own = np.zeros((family.n_causes, family.n_effects))
        self.highest, self._prior = 0.0, prior
        self._alarm: NoveltyAlarm | None = None
        # Without a cause that tells types apart, such as after tasks in which nothing was tried, the prior stays.
        if (judged := self.known.judged).size:
            frequency = knowledge.shared.causes.counts(judged)[:, 0]
            generator = stream(seed, "long-lived", "alarm", knowledge.n_tasks)
            self._alarm = self.known.telling.alarm(prior, frequency, knowledge.n_tasks, false_alarm, generator)

    def observe(self, effects: tuple[tuple[int, int], ...]) -> None:
        """Take in the effects of an act; a cause tells of the type at its first effect alone.

        The same scene answers the same act alike: repeats are no news of the type.
        """
        for cause, effect in effects:
            self.own[cause, effect] += 1
            place = self.known.place_of.get(cause)
            if self._alarm is not None and place is not None:
                self._alarm.observe(place, effect)
                self.highest = max(self.highest, self._alarm.score)

    @property
    def belief(self) -> Array:
        """In the known types and, last, in an unknown one, (n_types + 1,)."""
        if self._alarm is None:
            return with_unknown(self._prior, UNKNOWN)
        odds = self._alarm.score + np.log(UNKNOWN / (1 - UNKNOWN))
        return with_unknown(self._alarm.belief, ALARMED if self._alarm.alarm else 1 / (1 + np.exp(-odds)))

    @property
    def alarmed(self) -> bool:
        """Whether the alarm was raised, or no type is known."""
        return len(self.known) == 0 if self._alarm is None else self._alarm.alarm


def with_unknown(known: Array, unknown: float) -> Array:
    """A law over known types (n_types,), and an unknown type last; certainly unknown where none is known."""
    return np.append((1 - unknown) * known, unknown) if len(known) else np.ones(1)
