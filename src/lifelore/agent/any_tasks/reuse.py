"""Which type a task has, and which known policy to run: Bayesian policy reuse over the library of a life.

β      ← prior over types, given the context                          an action prior over policies, decayed
π      ← the policy of the most believed type; where it is hopeless, of the largest expected return under β
β      ← β · P(outcome | state, action; type) after each move         or by the returns of episodes
alarm  ← what is seen fits no known type, at a stated rate of false alarms
"""

import math

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.experience import Experience
from lifelore.agent.any_tasks.known_types import KnownTypes, known_returns
from lifelore.agent.any_tasks.moves import Counts, Pairs
from lifelore.agent.any_tasks.task_settings import TaskSettings
from lifelore.agent.types.novelty import NoveltyAlarm
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.novelty.calibration import LEAST_ALARMS
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

Array = NDArray[np.float64]

MOST_AGAINST = 1.0, 3.0
"""Most nats by which the return of one episode speaks for or against another type."""
MOST_TASKS = 8000
"""Most simulated tasks behind an alarm by returns, unless the stated rate itself needs more."""
SIGNALS = ("moves", "returns")
"""What recognition goes by."""


class TaskReuse:
    """Reuse of the library in one task.

    Parameters
    ----------
    experience : Experience
        At least one of its types has a policy.
    known : KnownTypes
        Of the same experience.
    prior : (n_types,) float
    settings : TaskSettings
        Its ``signals`` say whether each move is a signal, or the return of each episode that one policy ran.
    """

    def __init__(self, experience: Experience, known: KnownTypes, prior: Array, settings: TaskSettings) -> None:
        seed, false_alarm = settings.seed, experience.alarm_level(settings.false_alarm)
        self.known = known
        self.policies = experience.policies
        self.names = tuple(one.name for one in known.types)
        self.by_moves = settings.signals == "moves"
        likelihood = LikelihoodSignal(self._log_likelihood, len(known), len(self.policies))
        members = [one.members for one in known.types]
        library = PolicyLibrary(
            known_returns(experience, members, self.policies),
            likelihood if self.by_moves else None,  # pyright: ignore[reportArgumentType]
            self.names,
            self.policies,
            prior,
        )
        static, generator = TypeDynamics.static(), stream(seed, "any tasks", "alarm", experience.n_tasks)
        self.alarm: NoveltyAlarm | NoveltyDetector
        if self.by_moves:
            self.alarm = known.moves.alarm(prior, known.frequency, experience.n_tasks, false_alarm, generator)
        else:
            # A rarer alarm would need more simulated tasks than it is worth.
            false_alarm = max(false_alarm, min(settings.false_alarm, LEAST_ALARMS / MOST_TASKS))
            n_tasks = max(1000, int(np.ceil(LEAST_ALARMS / false_alarm)))
            self.alarm = NoveltyDetector.calibrate(
                library, false_alarm=false_alarm, horizon=settings.learning.episode_cap, n_tasks=n_tasks,
                seed=generator, dynamics=static,
            )  # fmt: skip
        detector = self.alarm if isinstance(self.alarm, NoveltyDetector) else None
        self.agent = BayesianPolicyReuse(library, dynamics=static, seed=seed, novelty=detector)
        self._hopeless = {name for name in self.policies if experience.is_hopeless(name)}
        self._own: dict[int, Array] = {}  # outcomes of this task by cause
        self._short: list[float] = []
        self._ran: list[tuple[int, float]] = []
        self._deviation = float(np.mean(library.performance.deviation))
        self.policy = self.select()

    # ---- choose ------------------------------------------------------------------------------------

    @property
    def belief(self) -> Array:
        """β over the known types, (n_types,)."""
        return self.agent.belief

    @property
    def best(self) -> int:
        """Number of the type that is believed most."""
        return int(self.belief.argmax())

    @property
    def alarmed(self) -> bool:
        """Whether the alarm was raised: no known type fits."""
        return self.alarm.alarm

    def select(self) -> str:
        """The policy to run now, by name.

        Moves tell the type whichever policy runs, and another takes over once another type is believed most. So
        what a policy earns in a whole episode of another type is rarely at stake, and rarely seen: it counts only
        where the policy of the most believed type is hopeless, or returns alone tell types.
        """
        self._believed, own = self.best, self.own_policy()
        if not self.by_moves or own is None or own in self._hopeless:
            own = self.policies[self.agent.select()]
        self.policy = own
        return own

    @property
    def shortfall(self) -> float:
        """By how many deviations the episodes so far fell short of what the belief promised before each.

        Where types that are believed promise different returns, a low one is no surprise.
        """
        return float(np.sum(self._short) / np.sqrt(len(self._short))) if self._short else 0.0

    # ---- signals -----------------------------------------------------------------------------------

    def observe(self, pairs: Pairs) -> None:
        """Take in a move, by codes; another policy runs from here where another type is believed most."""
        if not isinstance(self.alarm, NoveltyAlarm):
            return
        for cause, outcome in pairs:
            found = self.known.moves.place(cause, outcome)
            if found is not None:
                self.alarm.observe(*found)
                self.agent.observe(self.policy, found)
                place, effect = found
                self._own.setdefault(place, np.zeros(self.known.moves.base.shape[1]))[effect] += 1
        if self.best != self._believed:
            self.select()

    def end_episode(self, policy: str | None, earned: float, reused: bool) -> None:
        """End an episode.

        Parameters
        ----------
        policy : str, optional
            That ran it from begin to end.
        earned : float
            Its return.
        reused : bool
            Whether known policies played it.
        """
        if reused:
            mean, deviation = self._promised
            self._short.append((mean - earned) / deviation)
        if policy is not None:
            self._ran.append((self.policies.index(policy), earned))
            if not self.by_moves:
                self.agent.observe(policy, earned)
        self.agent.end_episode()

    def begin_episode(self) -> str:
        """The policy for the next episode, by name."""
        policy = self.select()
        values = self.agent.library.performance.mean[:, self.policies.index(policy)]
        mean = float(self.belief @ values)
        self._promised = mean, float(np.hypot(self._deviation, np.sqrt(self.belief @ (values - mean) ** 2)))
        return policy

    def _log_likelihood(self, policy: int, found: tuple[int, int]) -> Array:
        place, effect = found
        own = self._own.get(place)
        if own is None:
            return np.log(self.known.moves.laws[:, place, effect])
        return np.log(self.known.moves.law(place, own)[:, effect])

    # ---- what it comes to --------------------------------------------------------------------------

    def by_name(self, belief: Array) -> dict[str, float]:
        """A belief over the known types by name."""
        return dict(zip(self.names, belief.tolist(), strict=True))

    def best_member(self) -> dict[str, float]:
        """Belief in the most believed type, by the name of its first member."""
        return {self.known.types[self.best].members[0]: float(self.belief.max())}

    def own_policy(self) -> str | None:
        """The best policy of the type that is believed most, by name; None where it has none."""
        own = [name for name in self.known.types[self.best].members if name in self.policies]
        values = self.agent.library.performance.mean[self.best]
        return max(own, key=lambda name: values[self.policies.index(name)]) if own else None

    def differs(self, moves: Counts) -> bool:
        """Whether the moves of the task, also after an alarm, are better explained by a type of its own.

        Where moves are no signals, the alarm says it.
        """
        if self.alarmed and not self.by_moves:
            return True
        return (
            self.known.moves.evidence_of_another(self.best, self.known.moves.own(moves))
            + self.returns_against(self.best)
            > 0
        )

    def returns_against(self, type_: int) -> float:
        """Evidence in nats that the returns of policies are not those that they get from a type."""
        outcomes = self.agent.library.performance
        usual, wide = float(outcomes.mean.mean()), float(np.hypot(outcomes.mean.std(), self._deviation))
        against = 0.0
        for policy, earned in self._ran:
            known = log_normal(earned, float(outcomes.mean[type_, policy]), self._deviation)
            against += float(np.clip(log_normal(earned, usual, wide) - known, -MOST_AGAINST[0], MOST_AGAINST[0]))
        return float(np.clip(against, -MOST_AGAINST[1], MOST_AGAINST[1]))


def log_normal(value: float, mean: float, deviation: float) -> float:
    """Log density of a normal distribution."""
    return -0.5 * ((value - mean) / deviation) ** 2 - math.log(deviation * math.sqrt(2 * math.pi))
