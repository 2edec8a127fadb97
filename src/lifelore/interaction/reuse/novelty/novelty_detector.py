"""A detector of tasks and users whose type the library does not have: a probability, and a calibrated alarm.

    probability   Bayes' rule from the prior `mass` and the log odds of `UnknownUsers`
    alarm         the statistic of `Misfit` exceeds a threshold that simulated known tasks exceed at a stated rate;
                  it also looks for types that lie near the known types

The thesis proposes the belief's spread (§5.2), which rises too little: a belief in a wrong type is as narrow as a
belief in the right one.
"""

import warnings
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Models
from lifelore.interaction.reuse.novelty.calibration import NoveltyCalibration, check_rate, known_statistic
from lifelore.interaction.reuse.novelty.misfit import MeanPairs, Misfit, pairs_of
from lifelore.interaction.reuse.novelty.unknown_evidence import unknown_evidence
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, named_part
from lifelore.interaction.reuse.unknown_users import FIRST, MASS
from lifelore.interaction.selection import SelectionRule, rule_of
from lifelore.interaction.signals.return_signal import ReturnSignal

OUTDATED = "an earlier version calibrated this alarm; it raises no more until it is calibrated again"


class NoveltyDetector:
    """Watches a single task: how probable it is that no known type fits, and an alarm where it was calibrated.

    Parameters
    ----------
    library : PolicyLibrary
        Read once: what it learns later does not count.
    mass : float
        Prior probability that no known type fits, in (0, 1).
    prior : (n_types,) float, optional
        Of the known types; the library's by default.
    dynamics : TypeDynamics, optional
        As for an agent.
    models : {"uncertain", "plug-in"}
        Whether parameters of known types are as uncertain as the runs leave them, or taken for exact.
    calibration : NoveltyCalibration, optional
        Made by `calibrate`; without it there is no alarm.

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
    >>> for _ in range(5):
    ...     detector.update("policy 0", 5.0)  # neither type pays 5
    >>> detector.alarm, detector.probability > 0.9
    (True, True)
    """

    def __init__(
        self,
        library: PolicyLibrary,
        mass: float = MASS,
        prior: ArrayLike | None = None,
        dynamics: Dynamics | None = None,
        models: Models = "uncertain",
        calibration: NoveltyCalibration | None = None,
    ) -> None:
        if not 0 < mass < 1:
            raise InputError(f"novelty must lie between 0 and 1, the prior that no known type fits, got {mass}")
        self.library, self.mass, self.calibration = library, float(mass), calibration
        self._agent = {"prior": prior, "dynamics": dynamics, "models": models}
        self._rows = unknown_evidence(library, **self._agent)
        self._misfit = Misfit(self._rows)
        self.alarm_episode: int | None = None

    @classmethod
    def calibrate(
        cls,
        library: PolicyLibrary,
        rule: SelectionRule | str | None = None,
        *,
        false_alarm: float = 0.01,
        horizon: int = 30,
        n_tasks: int = 10_000,
        mass: float = MASS,
        seed: int | np.random.Generator = 0,
        **agent: Any,
    ) -> Self:
        """A detector whose threshold comes from simulated tasks of the library's types.

        True parameters of a simulated task are drawn from what the library's runs say of them, so that the rate of
        false alarms is right for learnt models too.

        Parameters
        ----------
        rule : SelectionRule or str, optional
            The agent's rule; by default that of an agent.
        false_alarm : float
            Probability of an alarm within the horizon in a task of a known type, in (0, 1).
        horizon : int
            Number of signals, at least 1. No alarm is raised after it.
        n_tasks : int
            Number of simulated tasks, at least 20 / false_alarm. The rate has a relative standard error of
            1 / √(n_tasks × false_alarm): a tenth for 1 % and 10,000 tasks.
        mass : float
            Prior probability that no known type fits, in (0, 1).
        seed : int or numpy generator
        **agent
            The agent's ``prior``, ``dynamics`` and ``models``, where they are not the default.

        Raises
        ------
        InputError
            An argument breaks its rule, or signals are neither outcomes nor categories.
        """
        check_rate(false_alarm, n_tasks)
        generator = stream(seed, "novelty calibration")
        known = known_statistic(library, rule_of(rule, library), horizon, n_tasks, generator, **agent)
        log_odds = isinstance(pairs_of(library.signal, library.prior), MeanPairs)
        return cls(library, mass, **agent, calibration=NoveltyCalibration.of(known, false_alarm, log_odds))

    def restart(self) -> Self:
        """A detector for another task, with the same settings and calibration and without signals."""
        return type(self)(self.library, self.mass, **self._agent, calibration=self.calibration)

    # ---- signals ---------------------------------------------------------------------------------------

    def update(self, policy: int | str, signal: Any) -> None:
        """Judge the signal of a policy, and end the episode: `observe` and `end_episode`."""
        self.observe(policy, signal)
        self.end_episode()

    def observe(self, policy: int | str, signal: Any) -> None:
        """Judge a signal of a policy within an episode.

        Raises
        ------
        NotFoundError
            There is no such policy.
        InputError
            The library's signals cannot be the signal. The detector stays as it was.
        """
        index, known = self.library.index_of_policy(policy), self.calibration
        if known is None:
            self._rows.observe(0, index, signal)
            return
        self._misfit.observe(0, index, signal)
        watching = self.alarm_episode is None and self.n_signals <= known.horizon
        if watching and self.score > known.threshold:
            self.alarm_episode = self.n_signals

    def end_episode(self) -> None:
        """End an episode: the type may have changed before the next."""
        self._rows.end_episode(0)

    # ---- answers ---------------------------------------------------------------------------------------

    @property
    def n_signals(self) -> int:
        """Number of signals judged for the alarm."""
        return int(self._misfit.n_signals[0])

    @property
    def log_odds(self) -> float:
        """Evidence of a broad type over that of the known types in nats, without the prior."""
        return float(self._rows.unknown.log_odds[0] - FIRST)

    @property
    def probability(self) -> float:
        """Probability that no known type fits, by Bayes' rule from the prior `mass`, in [0, 1]."""
        log_odds = self.log_odds + np.log(self.mass) - np.log1p(-self.mass)
        return float(np.exp(-np.logaddexp(0.0, -log_odds)))

    @property
    def alarm(self) -> bool:
        """Whether an alarm was raised within the horizon; never without a calibration."""
        return self.alarm_episode is not None

    @property
    def score(self) -> float:
        """The statistic: log odds of outcomes, else in deviations from known tasks; 0 before the first signal.

        Raises
        ------
        InputError
            The detector is not calibrated.
        """
        if self.calibration is None:
            raise InputError("score needs a calibrated detector; make it by NoveltyDetector.calibrate")
        if not self.n_signals:
            return 0.0
        place = min(self.n_signals, self.calibration.horizon) - 1
        found = self._misfit.statistic(0) - self.calibration.mean[place]
        return float(found / self.calibration.deviation[place])

    # ---- the state as arrays ---------------------------------------------------------------------------

    def state(self) -> dict[str, NDArray[Any]]:
        """What the task has shown, as small arrays; policies that were not tried take no room.

        ``numbers`` (mass, log odds without a prior), ``log_belief`` and ``task.*`` of the known types, ``places``,
        ``shown`` and ``log_odds`` of the broad type. With a calibration its arrays, ``misfit`` (signals, degrees
        of freedom, and the signal of the alarm or -1) and ``misfit_by_type``.
        """
        task = self._rows.state(0)
        state = {f"task.{name}": array for name, array in task.items() if not name.startswith("unknown.")} | {
            "numbers": np.array([self.mass, self.log_odds]),
            "log_belief": self._rows.log_belief[0].copy(),
            "places": task["unknown.places"],
            "shown": task["unknown.shown"],
            "log_odds": task["unknown.log_odds"],
        }
        if self.calibration is None:
            return state
        misfit, alarm = self._misfit, -1 if self.alarm_episode is None else self.alarm_episode
        sums = [misfit.n_signals[0], misfit.freedom[0], alarm]
        watched = {"misfit": np.array(sums, np.float64), "misfit_by_type": misfit.by_type[0].copy()}
        return state | watched | self.calibration.to_arrays()

    @classmethod
    def restored(
        cls,
        state: Mapping[str, NDArray[Any]],
        library: PolicyLibrary,
        dynamics: Dynamics | None = None,
        models: Models = "uncertain",
    ) -> Self:
        """The detector of a `state`, bit for bit; InputError where it is not of this library.

        An alarm of outcomes that an earlier version calibrated stays where it was raised; else it is never raised,
        with a warning.
        """
        # Sessions of earlier versions have no calibration: they computed the probability alone.
        known = NoveltyCalibration.from_arrays(state) if "calibration" in state else None
        # Earlier calibrations of outcomes are for another statistic.
        outdated = np.size(state.get("misfit", ())) == 4 and isinstance(library.signal, ReturnSignal)
        if known is not None and outdated:
            known = replace(known, threshold=np.inf)
        try:
            mass, log_odds = np.asarray(state["numbers"], np.float64).tolist()
            detector = cls(library, mass, None, dynamics, models, known)
            task = {name: state[name] for name in ("places", "policies", "shown") if name in state}
            n_numbers = detector._rows.unknown.shown.shape[-1]
            if "log_odds" not in state and np.shape(task["shown"])[1:] != (n_numbers,):
                # Earlier sessions took outcomes in bins for normal: the statistics begin anew.
                task = {"places": np.empty((0, 1), np.int64), "shown": np.empty((0, n_numbers))}
            unknown = {f"unknown.{name}": array for name, array in task.items()}
            # Earlier sessions have the log odds without their prior alone, where a bit may differ.
            unknown["unknown.log_odds"] = state.get("log_odds", np.array(log_odds + FIRST))
            detector._rows.restore(0, state["log_belief"], named_part(state, "task.") | unknown)
            if known is not None:
                misfit = detector._misfit
                misfit.n_signals[0], *_, misfit.freedom[0], alarm = state["misfit"].tolist()
                misfit.by_type[0] = 0 if outdated else state["misfit_by_type"]
                detector.alarm_episode = None if alarm < 0 else int(alarm)
        except (KeyError, ValueError, TypeError) as error:
            raise InputError(f"this is no evidence of an unknown type of this library: {error}") from None
        if not np.isfinite([log_odds, detector._misfit.statistic(0)]).all():
            raise InputError("the evidence of an unknown type must be finite")
        if known is not None and known.threshold == np.inf and not detector.alarm:
            warnings.warn(OUTDATED, stacklevel=2)
        return detector
