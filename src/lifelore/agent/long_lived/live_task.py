"""One task of a long-lived agent, from top to bottom: perceive, recognise, act, notice, learn, remember.

β ← prior over types, given the context and the date                                   recognise
for each episode:
    look; features of the scene                                                        perceive
    until the episode ends:
        p ← probability that no known type fits                                        notice
        act as the behaviour with the largest Σ_i β_i V_i(behaviour) says              reuse
        (between the first episode and the last, with laws drawn from what is known)
        β, p and the task's own counts take in the effects of the act
an alarm, or effects that tell the task from its type: a new type; else as believed    learn
count the effects, the best acts, and the belief in this context                       remember
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.knowledge import Knowledge, TaskNews
from lifelore.agent.long_lived.novelty_alarm import calibrated_alarm
from lifelore.agent.long_lived.task_family import Abilities, AgentTask, Plan
from lifelore.core.protocols import Record
from lifelore.core.streams import stream
from lifelore.domains.task_stream import DrawnTask
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse

Array = NDArray[np.float64]

ALARMED = 0.99
"""Least belief in an unknown type after an alarm; the known types then hardly count."""


@dataclass(frozen=True)
class LivingSettings:
    """How the agent lives through a task.

    Parameters
    ----------
    n_episodes : int
        Of a task, at least 1.
    false_alarm : float
        Probability of an alarm in a task of a known type, in (0, 1).
    unknown : float
        Prior probability that no known type fits, in (0, 1).
    """

    n_episodes: int = 8
    false_alarm: float = 0.05
    unknown: float = 0.05


@dataclass
class Decision:
    """Why the agent did an act.

    act : int
    behaviour : int
        Number of the type whose behaviour was followed; the last stands for an unknown type.
    belief : (n_types + 1,) float64
        In the known types and, last, in an unknown one, before the act.
    expected : (n_types + 1,) float64
        Expected return of each behaviour under the belief.
    scene : str
    reward : float
    effects : tuple of (int, int)
    """

    act: int
    behaviour: int
    belief: Array
    expected: Array
    scene: str
    reward: float = 0.0
    effects: tuple[tuple[int, int], ...] = ()


@dataclass
class LivedTask:
    """What happened in a task.

    drawn : DrawnTask
    returns : list of float
        Of the episodes.
    decisions : list of list of Decision
        Of each episode.
    prior : (n_types,) float64
        Over the types that were known before the task.
    types : list of str
        Their names.
    alarm : bool
        Whether no known type fitted.
    alarm_score : float
        Largest score of the detector, in deviations of known tasks.
    learnt : str
        Name of the type that learnt most from the task.
    """

    drawn: DrawnTask
    returns: list[float] = field(default_factory=list)
    decisions: list[list[Decision]] = field(default_factory=list)
    prior: Array = field(default_factory=lambda: np.zeros(0))
    types: list[str] = field(default_factory=list)
    alarm: bool = False
    alarm_score: float = 0.0
    learnt: str = ""

    def to_dict(self) -> dict[str, Any]:
        """The task as JSON data, without its decisions."""
        return {
            "task": self.drawn.number,
            "context": self.drawn.context,
            "returns": [round(value, 4) for value in self.returns],
            "known_types": len(self.types),
            "alarm": self.alarm,
            "learnt": self.learnt,
        }


class Recognition:
    """The belief over types in one task, and the alarm that none fits."""

    def __init__(self, knowledge: Knowledge, prior: Array, settings: LivingSettings, seed: int) -> None:
        self.known = knowledge.known_types()
        self.own = np.zeros((knowledge.family.n_causes, knowledge.family.n_effects))
        self.agent: BayesianPolicyReuse | None = None
        self.alarm: NoveltyDetector | None = None
        self.highest = 0.0
        self._judged: set[int] = set()
        if len(self.known):
            library, judged = self.known.library(prior), self.known.judged
            self._place = {int(cause): place for place, cause in enumerate(judged)}
            self.agent = BayesianPolicyReuse(library, dynamics=TypeDynamics.static())
            frequency = knowledge.shared.causes.counts(judged)[:, 0]
            self.alarm = calibrated_alarm(
                library,
                np.maximum(frequency, 0.5),
                max(1, round(frequency.sum() / max(knowledge.n_tasks, 1))),
                settings.false_alarm,
                stream(seed, "long-lived", "alarm", knowledge.n_tasks),
                settings.unknown,
            )

    @property
    def belief(self) -> Array:
        """In the known types and, last, in an unknown one, (n_types + 1,)."""
        if self.agent is None or self.alarm is None:
            return np.ones(1)
        unknown = max(self.alarm.probability, ALARMED if self.alarm.alarm else 0.0)
        return np.append((1 - unknown) * self.agent.belief, unknown)

    def observe(self, effects: tuple[tuple[int, int], ...]) -> None:
        """Take in the effects of an act; a cause counts for the alarm at its first effect alone."""
        for cause, effect in effects:
            self.own[cause, effect] += 1
            if self.agent is None or self.alarm is None or cause not in self._place:
                continue
            place, belief = self._place[cause], self.agent.belief
            self.agent.update(place, effect)
            if cause not in self._judged:
                self._judged.add(cause)
                self.alarm.observe(belief, place, effect)
                self.highest = max(self.highest, self.alarm.score)

    @property
    def alarmed(self) -> bool:
        """Whether the alarm was raised, or no type is known."""
        return self.alarm is None or self.alarm.alarm


def live_task(
    knowledge: Knowledge,
    drawn: DrawnTask,
    task: AgentTask,
    abilities: Abilities,
    settings: LivingSettings,
    name: str,
    seed: int = 0,
) -> tuple[LivedTask, list[Record]]:
    """Live through a task; `knowledge` learns from it.

    Parameters
    ----------
    knowledge : Knowledge
    drawn : DrawnTask
        Its context is observed; its hidden type is only copied into the result.
    task : AgentTask
    abilities : Abilities
    settings : LivingSettings
    name : str
        Of the new type, if the task has one; unique in the fleet.
    seed : int

    Returns
    -------
    (LivedTask, list of Record)
        What happened, and the records by which memory adds what was learnt.
    """
    known, shared = knowledge.known_types(), knowledge.shared
    lived = LivedTask(drawn, types=[one.name for one in known.types])

    # Recognise: which types does this context usually have?
    lived.prior = np.full(len(known), 1 / max(len(known), 1))
    if abilities.prior and len(known):
        lived.prior = knowledge.type_prior().prior(drawn.context, drawn.number)
    recognition = Recognition(knowledge, lived.prior, settings, seed)
    shared.guided = abilities.prior

    # Act: perceive, reuse the behaviours of the known types, and let every effect tell more of the type.
    effects: list[tuple[int, int]] = []
    moves: list[tuple[int, int]] = []
    for episode in range(settings.n_episodes):
        task.begin()
        between = 0 < episode < settings.n_episodes - 1
        decisions, ended = [], False
        while not ended:
            generator = stream(seed, "long-lived", "episode", drawn.number, episode) if between else None
            decision = decide(knowledge, task, recognition, generator, trying=between and not decisions)
            step = task.act(decision.act)
            decision.reward, decision.effects, ended = step.reward, step.effects, step.ended
            decisions.append(decision)
            recognition.observe(step.effects)
            effects += step.effects
            if task.moved is not None:
                moves.append(task.moved)
        lived.returns.append(sum(decision.reward for decision in decisions))
        lived.decisions.append(decisions)

    # Notice: does any known type fit?
    lived.alarm, lived.alarm_score = recognition.alarmed, recognition.highest
    believed = recognition.belief[:-1] / max(float(recognition.belief[:-1].sum()), 1e-300)
    fits = len(known) > 0 and not lived.alarm and not known.differs(int(believed.argmax()), effects)
    if not fits and (abilities.reuse or not len(known)):
        row, belief = len(known), {name: 1.0}
    else:
        row = int(believed.argmax()) if abilities.reuse else 0
        believed = believed if abilities.reuse else np.ones(1)
        belief = {one.members[0]: value for one, value in zip(known.types, believed.tolist(), strict=True)}
    lived.learnt = max(belief, key=belief.__getitem__)

    # Learn and remember: types learn the effects as far as they are believed, contexts their best acts and types.
    contexts, best = task.best_acts(known.laws(recognition.own)[row], shared)
    return lived, knowledge.learn(TaskNews(drawn.context, drawn.number, belief, effects, moves, contexts, best))


def decide(
    knowledge: Knowledge,
    task: AgentTask,
    recognition: Recognition,
    generator: np.random.Generator | None = None,
    trying: bool = False,
) -> Decision:
    """The act of the behaviour that is worth most under the belief; with a generator, under laws drawn from it.

    Drawn laws (posterior sampling) try acts as often as they may be the best ones. With `trying` it does not give
    up.
    """
    known = recognition.known
    laws = known.laws(recognition.own, generator)
    tried = known.tried(recognition.own)
    plan: Plan = task.plan(laws, tried, len(laws) - 1, knowledge.shared)
    belief = recognition.belief
    expected = belief @ plan.values
    behaviour = int(expected.argmax())
    act = plan.trying[behaviour] if trying else plan.acts[behaviour]
    return Decision(int(act), behaviour, belief, expected, task.describe())
