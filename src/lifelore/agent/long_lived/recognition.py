"""Which type a task has: the belief over the known types, and the alarm that none fits."""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.novelty_alarm import alarm_calibration
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector

Array = NDArray[np.float64]

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
    unknown : float
        Prior probability that no known type fits, in (0, 1).
    seed : int

    Attributes
    ----------
    own : (n_causes, n_effects) float64
        Counts of what the task has shown.
    highest : float
        Largest score of the detector.
    """

    def __init__(self, knowledge: Knowledge, prior: Array, false_alarm: float, unknown: float, seed: int) -> None:
        self.known, family = knowledge.known_types(), knowledge.family
        self.own = np.zeros((family.n_causes, family.n_effects))
        self.highest = 0.0
        self._judged: set[int] = set()
        self._before = with_unknown(prior, unknown)
        self._agent = None
        # Without a cause that tells types apart, such as after tasks in which nothing was tried, the prior stays.
        if (judged := self.known.judged).size:
            library, static = self.known.library(prior), TypeDynamics.static()
            frequency = knowledge.shared.causes.counts(judged)[:, 0]
            # Twice the usual number of causes: tasks of unknown types try more.
            horizon = max(1, round(2 * frequency.sum() / max(knowledge.n_tasks, 1)))
            generator = stream(seed, "long-lived", "alarm", knowledge.n_tasks)
            calibration = alarm_calibration(library, np.maximum(frequency, 0.5), horizon, false_alarm, generator)
            self._alarm = NoveltyDetector(library, unknown, prior, static, calibration=calibration)
            self._agent = BayesianPolicyReuse(library, prior=prior, dynamics=static, novelty=self._alarm)

    def observe(self, effects: tuple[tuple[int, int], ...]) -> None:
        """Take in the effects of an act; a cause tells of the type at its first effect alone.

        The same scene answers the same act alike: repeats are no news of the type.
        """
        for cause, effect in effects:
            self.own[cause, effect] += 1
            place = self.known.place_of.get(cause)
            if self._agent is not None and place is not None and cause not in self._judged:
                self._judged.add(cause)
                self._agent.update(place, effect)
                self.highest = max(self.highest, self._alarm.score)

    @property
    def belief(self) -> Array:
        """In the known types and, last, in an unknown one, (n_types + 1,)."""
        if self._agent is None:
            return self._before
        unknown = max(self._alarm.probability, ALARMED if self._alarm.alarm else 0.0)
        return with_unknown(self._agent.belief, unknown)

    @property
    def alarmed(self) -> bool:
        """Whether the alarm was raised, or no type is known."""
        return len(self.known) == 0 if self._agent is None else self._alarm.alarm


def with_unknown(known: Array, unknown: float) -> Array:
    """A law over known types (n_types,), and an unknown type last; certainly unknown where none is known."""
    return np.append((1 - unknown) * known, unknown) if len(known) else np.ones(1)
