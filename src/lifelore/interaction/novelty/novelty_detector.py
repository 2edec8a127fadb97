"""A detector of tasks and users whose type the library does not have, with a stated rate of false alarms.

Surprise alone is no sign of a new type: it falls where the noise is small and rises where it is large. The
detector compares each surprise with the surprise that the belief predicts, and each outcome with the outcome that
it predicts. The thesis proposes the belief's spread (§5.2), which rises too little: a belief in a wrong type is as
narrow as a belief in the right one.
"""

from collections.abc import Mapping
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.calibration import NoveltyCalibration, calibrate
from lifelore.interaction.novelty.novelty_statistics import NoveltyStatistics, NoveltySums
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import SelectionRule, default_rule

Array = NDArray[np.float64]


class NoveltyDetector:
    """Watches a single task and raises an alarm where no type of the library fits; made by `calibrate`.

    Parameters
    ----------
    library : PolicyLibrary
        Not copied; its models must not change.
    calibration : NoveltyCalibration
    mass : float
        Prior probability that no known type fits, in (0, 1).

    Attributes
    ----------
    alarm_episode : int or None
        Number of signals at which the alarm was raised; the alarm stays. None without an alarm.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories, or the mass breaks its rule.

    Examples
    --------
    >>> library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 1.0)
    >>> detector = NoveltyDetector.calibrate(library, false_alarm=0.05, horizon=10, n_tasks=1000)
    >>> agent = BayesianPolicyReuse(library)
    >>> for _ in range(5):
    ...     detector.update(agent, agent.select(), 5.0)  # neither type pays 5
    >>> detector.alarm, detector.probability > 0.9
    (True, True)
    """

    def __init__(self, library: PolicyLibrary, calibration: NoveltyCalibration, mass: float = 0.05) -> None:
        self._begin(NoveltyStatistics(library), calibration, mass)

    @classmethod
    def calibrate(
        cls,
        library: PolicyLibrary,
        rule: SelectionRule | None = None,
        *,
        false_alarm: float = 0.01,
        horizon: int = 30,
        n_tasks: int = 10_000,
        mass: float = 0.05,
        signal_count: ArrayLike | None = None,
        seed: int | np.random.Generator = 0,
        **agent: Any,
    ) -> Self:
        """A detector whose threshold comes from simulated tasks of the library's types.

        True parameters of a simulated task are drawn from what the library's runs say of them, so that the rate of
        false alarms is right for learnt models too.

        Parameters
        ----------
        rule : SelectionRule, optional
            The agent's rule; by default that of an agent.
        false_alarm : float
            Probability of an alarm within the horizon in a task of a known type, in (0, 1).
        horizon : int
            Number of episodes, at least 1. No alarm is raised after it.
        n_tasks : int
            Number of simulated tasks, at least 20 / false_alarm. The rate has a relative standard error of
            1 / √(n_tasks × false_alarm): a tenth for 1 % and 10,000 tasks.
        mass : float
            Prior probability that no known type fits, in (0, 1).
        signal_count : float or (n_types, n_policies) float, optional
            For a learnt `CategorySignal`: number of signals behind each row, pseudo-counts included.
        seed : int or numpy generator
        **agent
            The agent's settings where they are not the default, as `UserBeliefs` takes them, such as ``dynamics``
            and ``models``.

        Raises
        ------
        InputError
            An argument breaks its rule, or signals are neither outcomes nor categories.
        """
        generator = stream(seed, "novelty calibration") if isinstance(seed, int | np.integer) else seed
        rule = rule or default_rule(library)
        known = calibrate(library, rule, false_alarm, horizon, n_tasks, generator, signal_count, **agent)
        return cls(library, known, mass)

    def restart(self) -> Self:
        """A detector for another task, with the same calibration and without signals."""
        other = type(self).__new__(type(self))
        other._begin(self._test, self.calibration, self.mass)
        return other

    # ---- signals ---------------------------------------------------------------------------------------

    def update(self, agent: BayesianPolicyReuse, policy: int | str, signal: Any) -> None:
        """Let the agent learn from a signal, and judge the signal under the belief before it.

        Raises
        ------
        NotFoundError, InputError
            As for the agent's `update`; the agent and the detector stay as they were.
        """
        belief = agent.belief
        agent.update(policy, signal)
        self.observe(belief, policy, signal)

    def observe(self, belief: ArrayLike, policy: int | str, signal: Any) -> None:
        """Judge a signal under the belief (n_types,) before it.

        Raises
        ------
        NotFoundError
            There is no such policy.
        InputError
            The belief has another number of types, or the library's signals cannot be the signal.
        """
        library = self._test.library
        index, belief = library.index_of_policy(policy), np.asarray(belief, np.float64)
        if belief.shape != (library.n_types,):
            raise InputError(f"belief must be ({library.n_types},), got {belief.shape}")
        log_likelihood = np.asarray(library.signal.log_likelihood(index, signal), np.float64)
        numbers = self._test.laws.numbers([signal])
        self._test.add(self._sums, belief[None], np.array([index]), numbers, log_likelihood[None])
        watching = self.alarm_episode is None and self.episodes <= self.calibration.horizon
        if watching and self.score > self.calibration.threshold:
            self.alarm_episode = self.episodes

    # ---- answers ---------------------------------------------------------------------------------------

    @property
    def episodes(self) -> int:
        """Number of signals judged."""
        return int(self._sums.n_signals[0])

    @property
    def alarm(self) -> bool:
        """Whether an alarm was raised within the horizon."""
        return self.alarm_episode is not None

    @property
    def score(self) -> float:
        """Shortfall and surprise joined, in deviations from known tasks; alarms compare it with the threshold."""
        episode = min(max(self.episodes, 1), self.calibration.horizon) - 1
        found = self._test.statistic(self._sums)[0] - self.calibration.mean[episode]
        return float(found / self.calibration.deviation[episode]) if self.episodes else 0.0

    @property
    def surprise(self) -> float:
        """Standardised surprise: Σ (−log m − E) / √V over the root of the number of signals."""
        return float(self._sums.surprise[0] / max(self.episodes, 1) ** 0.5)

    @property
    def shortfall(self) -> float:
        """Standardised shortfall of outcomes; 0 where signals are no outcomes."""
        return float(self._sums.shortfall[0] / max(self.episodes, 1) ** 0.5)

    @property
    def probability(self) -> float:
        """Probability that no known type fits, by Bayes' rule from the prior `mass`, in [0, 1]."""
        log_odds = self._sums.log_odds[0] + np.log(self.mass) - np.log1p(-self.mass)
        return float(np.exp(-np.logaddexp(0.0, -log_odds)))

    # ---- the state as arrays ---------------------------------------------------------------------------

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """State and calibration as small arrays; policies that were not tried take no room."""
        sums = self._sums
        tried = np.flatnonzero(sums.shown[0].any(axis=1))
        numbers = [self.mass, -1 if self.alarm_episode is None else self.alarm_episode]
        numbers += [array[0] for array in (sums.n_signals, sums.surprise, sums.shortfall, sums.log_odds)]
        state = {"state": np.array(numbers, np.float64), "tried": tried, "shown": sums.shown[0, tried]}
        return state | self.calibration.to_arrays()

    @classmethod
    def from_arrays(cls, library: PolicyLibrary, arrays: Mapping[str, NDArray[Any]]) -> Self:
        """The detector of `to_arrays`, bit for bit.

        Raises
        ------
        InputError
            The arrays are no detector, or one of another library.
        """
        calibration = NoveltyCalibration.from_arrays(arrays)
        try:
            mass, alarm, *numbers = np.asarray(arrays["state"], np.float64).tolist()
            detector = cls(library, calibration, mass)
            sums, tried = detector._sums, np.asarray(arrays["tried"], np.int64)
            for array, number in zip(
                (sums.n_signals, sums.surprise, sums.shortfall, sums.log_odds), numbers, strict=True
            ):
                array[0] = number
            sums.shown[0, tried] = arrays["shown"]
        except (KeyError, ValueError, IndexError) as error:
            raise InputError(f"these arrays are no novelty detector of this library: {error}") from None
        detector.alarm_episode = None if alarm < 0 else int(alarm)
        return detector

    def _begin(self, test: NoveltyStatistics, calibration: NoveltyCalibration, mass: float) -> None:
        if not 0 < mass < 1:
            raise InputError(f"mass must lie between 0 and 1, got {mass}")
        self.calibration, self.mass = calibration, float(mass)
        self._test = test
        self._sums: NoveltySums = test.sums()
        self.alarm_episode: int | None = None
