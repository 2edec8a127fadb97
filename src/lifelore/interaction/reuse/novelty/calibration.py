"""The threshold of a false-alarm rate, from simulated tasks of known types that the agent's rule plays.

The statistic of known tasks is simulated over the horizon. A task raises an alarm where it exceeds the threshold
after any signal. The threshold is a quantile of the largest value of each simulated task. Before that, mean and
deviation after each signal standardise a misfit of counts, because errors of learnt models let it grow; log odds
have one scale.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Models
from lifelore.interaction.reuse.novelty.known_tasks import Tasks, known_tasks
from lifelore.interaction.reuse.novelty.misfit import Misfit
from lifelore.interaction.reuse.novelty.unknown_evidence import unknown_evidence
from lifelore.interaction.reuse.reuse_algorithm import Dynamics
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.selection import SelectionRule

Array = NDArray[np.float64]

TASKS_AT_ONCE = 2000
"""Simulated tasks that are held in memory at a time."""
LEAST_ALARMS = 20
"""Least number of simulated false alarms that a threshold may rest on."""


class Watched(NamedTuple):
    """What tasks showed in each episode, (n_tasks, n_episodes) float64 each.

    statistic : of `Misfit`, after the episode
    entropy : of the agent's belief before the episode, nats
    """

    statistic: Array
    entropy: Array


@dataclass(frozen=True, eq=False)
class NoveltyCalibration:
    """What a detector knows of tasks of known types.

    Parameters
    ----------
    false_alarm : float
        Probability of an alarm within the horizon in a task of a known type, in (0, 1).
    mean, deviation : (horizon,) float64
        Of the statistic after each signal; 0 and 1 for log odds.
    threshold : float
        Of the standardised statistic.
    n_tasks : int
        Simulated tasks behind them.
    """

    false_alarm: float
    mean: Array
    deviation: Array
    threshold: float
    n_tasks: int

    @classmethod
    def of(cls, statistic: Array, false_alarm: float, log_odds: bool = False) -> "NoveltyCalibration":
        """The calibration from the statistic of known tasks, (n_tasks, horizon).

        Parameters
        ----------
        log_odds : bool
            Whether the statistic is log odds, see `misfit`, and not standardised.

        Raises
        ------
        InputError
            The rate lies outside (0, 1), or the tasks are too few for it.
        """
        check_rate(false_alarm, len(statistic))
        mean, deviation = np.zeros(statistic.shape[1]), np.ones(statistic.shape[1])
        if not log_odds:
            mean, deviation = statistic.mean(axis=0), np.maximum(statistic.std(axis=0), 1e-6)
        largest = ((statistic - mean) / deviation).max(axis=1)
        threshold = float(np.quantile(largest, 1 - false_alarm, method="higher"))
        return cls(false_alarm, mean, deviation, threshold, len(statistic))

    @property
    def horizon(self) -> int:
        """Number of signals that the false-alarm rate is stated for."""
        return len(self.mean)

    def standardised(self, statistic: Array) -> Array:
        """The statistic after each signal (n, horizon), as the threshold reads it."""
        return (statistic - self.mean) / self.deviation

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The calibration as arrays; `from_arrays` restores every bit."""
        numbers = np.array([self.false_alarm, self.threshold, self.n_tasks], np.float64)
        return {"calibration": numbers, "calibration_by_signal": np.stack([self.mean, self.deviation])}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "NoveltyCalibration":
        """The calibration of `to_arrays`; InputError where the arrays are none."""
        try:
            false_alarm, threshold, n_tasks = arrays["calibration"].tolist()
            mean, deviation = np.array(arrays["calibration_by_signal"], np.float64)
        except (KeyError, ValueError) as error:
            raise InputError(f"a novelty calibration needs three numbers, mean and deviation: {error}") from None
        if not (mean.ndim == 1 and 0 < false_alarm < 1 and np.isfinite(mean).all() and (deviation > 0).all()):
            raise InputError("a novelty calibration must have finite means and positive deviations by signal")
        return cls(false_alarm, mean, deviation, threshold, int(n_tasks))


def known_statistic(
    library: PolicyLibrary,
    rule: SelectionRule,
    horizon: int,
    n_tasks: int,
    generator: np.random.Generator,
    **agent: Any,
) -> Array:
    """The statistic of simulated known tasks after each episode, (n_tasks, horizon); `agent` as for `watch`."""
    if horizon < 1:
        raise InputError(f"horizon must be at least 1 episode, got {horizon}")
    parts = list[Array]()
    for start in range(0, n_tasks, TASKS_AT_ONCE):
        n = min(TASKS_AT_ONCE, n_tasks - start)
        tasks = known_tasks(library, n, generator)
        parts.append(watch(library, rule, tasks, n, horizon, generator, **agent).statistic)
    return np.concatenate(parts)


def check_rate(false_alarm: float, n_tasks: int) -> None:
    """Raise InputError for a rate outside (0, 1), or one that `n_tasks` cannot calibrate."""
    if not 0 < false_alarm < 1:
        raise InputError(f"false_alarm must lie between 0 and 1, got {false_alarm}")
    if n_tasks * false_alarm < LEAST_ALARMS:
        raise InputError(
            f"n_tasks must be at least {LEAST_ALARMS} / false_alarm ({LEAST_ALARMS / false_alarm:.0f}) for a "
            f"false-alarm rate of {false_alarm}, got {n_tasks}"
        )


def watch(
    library: PolicyLibrary,
    rule: SelectionRule,
    tasks: Tasks,
    n: int,
    horizon: int,
    generator: np.random.Generator,
    *,
    prior: ArrayLike | None = None,
    dynamics: Dynamics | None = None,
    models: Models = "uncertain",
) -> Watched:
    """Play `n` tasks by a rule over the horizon, and record what a detector sees.

    Parameters
    ----------
    prior, dynamics, models
        Of the agent, as for `UserBeliefs`.
    """
    users = UserBeliefs(library, n, "f8", prior=prior, dynamics=dynamics, models=models, seed=generator)
    misfit, every = Misfit(unknown_evidence(library, n, prior, dynamics, models)), np.arange(n)
    seen = Watched(*np.empty((2, n, horizon)))
    for episode in range(horizon):
        seen.entropy[:, episode] = entropy(users.belief(every))
        policies = users.select(every, rule)
        signals = tasks(policies)
        users.update(every, policies, signals)
        misfit.observe(every, policies, signals)
        misfit.rows.end_episode(every)
        seen.statistic[:, episode] = misfit.statistic(every)
    return seen
