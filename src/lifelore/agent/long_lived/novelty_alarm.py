"""The alarm that no known type fits, calibrated on tasks that the known types would show.

A task shows the effects of causes that the agent chose. The calibration draws causes as often as earlier tasks had
them, and their effects from the known types, whose laws are in doubt as far as their counts leave them. A cause is
judged once a task: the same scene answers the same act alike in every episode, and repeats are no news.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.novelty.calibration import LEAST_ALARMS, NoveltyCalibration
from lifelore.interaction.reuse.novelty.known_tasks import known_tasks
from lifelore.interaction.reuse.novelty.misfit import Misfit
from lifelore.interaction.reuse.novelty.unknown_evidence import unknown_evidence

N_TASKS = 400
"""Simulated tasks behind the threshold, at least; more cost time and state the rate more precisely."""


def alarm_calibration(
    library: PolicyLibrary,
    frequency: NDArray[np.float64],
    horizon: int,
    false_alarm: float,
    generator: np.random.Generator,
) -> NoveltyCalibration:
    """The calibration of a detector for one task, whose type stays.

    Parameters
    ----------
    library : PolicyLibrary
        Its policies are causes, its signals their effects.
    frequency : (n_causes,) float
        How often earlier tasks had each cause, above 0.
    horizon : int
        Number of different causes that the rate of false alarms is stated for; at most n_causes count.
    false_alarm : float
        Probability of an alarm in a task of a known type, in (0, 1).
    """
    n_causes, n_tasks = len(frequency), max(N_TASKS, int(np.ceil(LEAST_ALARMS / false_alarm)))
    horizon = min(horizon, n_causes)
    # The largest of log frequency + Gumbel noise come first: a draw without replacement, by frequency.
    noise = generator.gumbel(size=(n_tasks, n_causes))
    order = np.argsort(-(np.log(frequency) + noise), axis=1)[:, :horizon]
    dynamics, every = TypeDynamics.static(), np.arange(n_tasks)
    misfit = Misfit(unknown_evidence(library, n_tasks, dynamics=dynamics))
    tasks = known_tasks(library, n_tasks, generator)
    found = np.empty((n_tasks, horizon))
    for place, causes in enumerate(order.T):
        misfit.observe(every, causes, tasks(causes))
        found[:, place] = misfit.statistic(every)
    return NoveltyCalibration.of(found, false_alarm)
