"""The threshold of a false-alarm rate, from simulated tasks of known types that the agent's rule plays.

The statistic of known tasks is simulated over the horizon. Its mean and deviation in each episode standardise it,
because errors of learnt models let it grow with the episodes. A task raises an alarm where the standardised
statistic exceeds the threshold in any episode. The threshold is a quantile of the largest value of each task.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import entropy
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.known_tasks import Tasks, known_tasks
from lifelore.interaction.novelty.novelty_statistics import NoveltyStatistics
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.selection import BeliefSampling, SelectionRule
from lifelore.interaction.selection.choice import choose
from lifelore.interaction.selection.rule import Deterministic

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

CERTAIN = 1 - 1e-6
"""Belief in a type from which on a simulated task is scored as certain; scores of certain tasks are shared."""
TASKS_AT_ONCE = 2000
"""Simulated tasks that are held in memory at a time."""
LEAST_ALARMS = 20
"""Least number of simulated false alarms that a threshold may rest on."""


class Watched(NamedTuple):
    """Statistics of tasks after each episode, (n_tasks, n_episodes) float64 each.

    statistic : shortfall and surprise joined
    surprise, shortfall : standardised, by the root of the number of episodes
    log_odds : of no known type against the types, without its prior
    entropy : of the belief before the episode, nats
    raw_surprise : sum of −log Σ F β in nats
    """

    statistic: Array
    surprise: Array
    shortfall: Array
    log_odds: Array
    entropy: Array
    raw_surprise: Array


@dataclass(frozen=True, eq=False)
class NoveltyCalibration:
    """What a detector knows of tasks of known types.

    Parameters
    ----------
    false_alarm : float
        Probability of an alarm within the horizon in a task of a known type, in (0, 1).
    mean, deviation : (horizon,) float64
        Of the statistic after each episode.
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

    @property
    def horizon(self) -> int:
        """Number of episodes that the false-alarm rate is stated for."""
        return len(self.mean)

    def standardised(self, statistic: Array) -> Array:
        """The statistic after each episode (n, horizon) in deviations from its mean on known tasks."""
        return (statistic - self.mean) / self.deviation

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The calibration as arrays; `from_arrays` restores every bit."""
        numbers = np.array([self.false_alarm, self.threshold, self.n_tasks], np.float64)
        return {"calibration": numbers, "calibration_mean": self.mean, "calibration_deviation": self.deviation}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "NoveltyCalibration":
        """The calibration of `to_arrays`; InputError where the arrays are none."""
        try:
            false_alarm, threshold, n_tasks = np.asarray(arrays["calibration"], np.float64).tolist()
            mean, deviation = (
                np.array(arrays[f"calibration_{name}"], np.float64) for name in ("mean", "deviation")
            )
        except (KeyError, ValueError) as error:
            raise InputError(f"a novelty calibration needs three numbers, mean and deviation: {error}") from None
        good = mean.ndim == 1 and mean.size and mean.shape == deviation.shape and (deviation > 0).all()
        if not (good and 0 < false_alarm < 1 and np.isfinite(mean).all()):
            raise InputError("a novelty calibration must have finite means and positive deviations by episode")
        return cls(false_alarm, mean, deviation, threshold, int(n_tasks))


def calibrate(
    library: PolicyLibrary,
    rule: SelectionRule,
    false_alarm: float,
    horizon: int,
    n_tasks: int,
    generator: np.random.Generator,
    signal_count: ArrayLike | None = None,
    **agent: Any,
) -> NoveltyCalibration:
    """The calibration of a library that a rule plays; see `NoveltyDetector.calibrate`."""
    if horizon < 1:
        raise InputError(f"horizon must be at least 1 episode, got {horizon}")
    check_rate(false_alarm, n_tasks)
    statistic = known_statistic(library, rule, horizon, n_tasks, generator, signal_count, **agent)
    return calibration_of(statistic, false_alarm)


def known_statistic(
    library: PolicyLibrary,
    rule: SelectionRule,
    horizon: int,
    n_tasks: int,
    generator: np.random.Generator,
    signal_count: ArrayLike | None = None,
    **agent: Any,
) -> Array:
    """The statistic of simulated tasks of known types after each episode, (n_tasks, horizon)."""
    statistics, parts = NoveltyStatistics(library), []
    for start in range(0, n_tasks, TASKS_AT_ONCE):
        n = min(TASKS_AT_ONCE, n_tasks - start)
        tasks = known_tasks(library, n, generator, signal_count)
        parts.append(watch(statistics, rule, tasks, n, horizon, generator, **agent).statistic)
    return np.concatenate(parts)


def calibration_of(statistic: Array, false_alarm: float) -> NoveltyCalibration:
    """The calibration from the statistic of known tasks, (n_tasks, horizon)."""
    check_rate(false_alarm, len(statistic))
    mean, deviation = statistic.mean(axis=0), np.maximum(statistic.std(axis=0), 1e-6)
    largest = ((statistic - mean) / deviation).max(axis=1)
    threshold = float(np.quantile(largest, 1 - false_alarm, method="higher"))
    return NoveltyCalibration(false_alarm, mean, deviation, threshold, len(statistic))


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
    statistics: NoveltyStatistics,
    rule: SelectionRule,
    tasks: Tasks,
    n: int,
    horizon: int,
    generator: np.random.Generator,
    **agent: Any,
) -> Watched:
    """Play `n` tasks by a rule over the horizon, and record what a detector sees.

    `agent` are arguments of `UserBeliefs`, such as ``dynamics``.
    """
    users = UserBeliefs(statistics.library, n, "f8", seed=generator, **agent)
    sums, every, algorithm = statistics.sums(n), np.arange(n), users.algorithm
    seen = Watched(*np.empty((len(Watched._fields), n, horizon)))
    raw = np.zeros(n)
    for episode in range(horizon):
        belief = algorithm.belief(users.log_belief)
        policies = _chosen(users, rule, belief)
        signals = tasks.signals(policies)
        if statistics.laws.pays:
            raw += statistics.add(sums, belief, policies, statistics.laws.numbers(signals))
            users.update(every, policies, signals)
        else:  # category numbers, whatever the names of the categories
            raw += statistics.add(sums, belief, policies, signals)
            users.update(every, policies, signals.astype(np.int64))
        root = (episode + 1) ** 0.5
        numbers = (statistics.statistic(sums), sums.surprise / root, sums.shortfall / root, sums.log_odds)
        for array, column in zip(seen, (*numbers, entropy(belief), raw), strict=True):
            array[:, episode] = column
    return seen


def _chosen(users: UserBeliefs, rule: SelectionRule, belief: Array) -> Numbers:
    """The policies that the rule selects, (n,); equal beliefs, and tasks certain of one type, are scored once."""
    learns = getattr(users, "outcomes", None) is not None  # scores depend on what a task has shown
    if learns or type(rule) is BeliefSampling:
        return users.select(np.arange(len(belief)), rule)
    if not isinstance(rule, Deterministic):
        return users.algorithm.select(belief, rule, users.generator)[0]
    certain = belief.max(axis=1) > CERTAIN
    chosen = np.empty(len(belief), np.int64)
    if (~certain).any():
        chosen[~certain] = _select_rows(users.algorithm, rule, belief[~certain], users.generator)
    if certain.any():
        types, of_task = np.unique(belief[certain].argmax(axis=1), return_inverse=True)
        scores = rule.scores(users.library, np.eye(belief.shape[1])[types])
        chosen[certain] = choose(scores[of_task], users.generator)
    return chosen


def _select_rows(
    algorithm: ReuseAlgorithm, rule: SelectionRule, belief: Array, generator: np.random.Generator
) -> Numbers:
    if (belief == belief[0]).all():
        scores = rule.scores(algorithm.library, belief[0])
        return choose(np.broadcast_to(scores, (len(belief), len(scores))), generator)
    return algorithm.select(belief, rule, generator)[0]
