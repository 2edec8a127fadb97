"""One task of a long-lived agent, from top to bottom: perceive, recognise, act, notice, learn, remember.

β ← prior over types, given the context and the date                                   recognise
for each episode:
    look; features of the scene                                                        perceive
    until the episode ends:
        p ← probability that no known type fits                                        notice
        act as the behaviour with the largest Σ_i β_i V_i(behaviour) says              reuse
        (between the first episode and the last, with laws drawn from what is known)
        β, p and the task's own counts take in the effects of the act
an alarm, or no type at all: a new type with this task's effects; else teach the type   learn
count the best acts, the belief in this context, and what followed what                remember
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.novelty_alarm import calibrated_alarm
from lifelore.agent.long_lived.task_family import Abilities, AgentTask, Plan
from lifelore.core.streams import stream
from lifelore.domains.task_stream import DrawnTask
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse

Array = NDArray[np.float64]


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
    sure : float
        Belief from which a type is taught by a task, in (0.5, 1].
    """

    n_episodes: int = 8
    false_alarm: float = 0.05
    unknown: float = 0.05
    sure: float = 0.8


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
    learnt : str or None
        Name of the type that learnt from the task; None where no type was sure enough.
    """

    drawn: DrawnTask
    returns: list[float] = field(default_factory=list)
    decisions: list[list[Decision]] = field(default_factory=list)
    prior: Array = field(default_factory=lambda: np.zeros(0))
    types: list[str] = field(default_factory=list)
    alarm: bool = False
    alarm_score: float = 0.0
    learnt: str | None = None

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
        self.known, self.settings = knowledge.types, settings
        self.own = np.zeros((knowledge.family.n_causes, knowledge.family.n_effects))
        self.agent: BayesianPolicyReuse | None = None
        self.alarm: NoveltyDetector | None = None
        self._judged: set[int] = set()
        self.highest = 0.0
        if len(self.known):
            library = self.known.library(prior)
            self._place = {int(cause): place for place, cause in enumerate(self.known.judged)}
            self.agent = BayesianPolicyReuse(library, dynamics=TypeDynamics.static())
            self.alarm = calibrated_alarm(
                library,
                np.maximum(knowledge.causes[self.known.judged], 0.5),
                max(1, round(knowledge.causes[knowledge.family.judges].sum() / max(knowledge.n_tasks, 1))),
                settings.false_alarm,
                stream(seed, "long-lived", "alarm", knowledge.n_tasks),
                settings.unknown,
            )

    @property
    def belief(self) -> Array:
        """In the known types and, last, in an unknown one, (n_types + 1,)."""
        if self.agent is None or self.alarm is None:
            return np.ones(1)
        unknown = self.alarm.probability
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
) -> LivedTask:
    """Live through a task; `knowledge` learns from it. `name` is of the new type, if there will be one."""
    lived = LivedTask(drawn, types=[known.name for known in knowledge.types.types])

    # Recognise: which types does this context usually have?
    n_types, shared = len(knowledge.types), knowledge.shared
    prior = np.full(n_types, 1 / max(n_types, 1))
    if abilities.prior and n_types:
        prior = knowledge.type_prior().prior(drawn.context, drawn.number)
    lived.prior = prior
    recognition = Recognition(knowledge, prior, settings, seed)
    shared.guided = abilities.prior

    effects: list[tuple[int, int]] = []
    for episode in range(settings.n_episodes):
        task.begin()
        # The episodes between the first and the last also try what may be better.
        between = 0 < episode < settings.n_episodes - 1
        names = ("long-lived", "episode", drawn.number, episode)
        decisions, ended = [], False
        while not ended:
            generator = stream(seed, *names) if between else None
            decision = decide(knowledge, task, recognition, generator, trying=between and not decisions)
            step = task.act(decision.act)
            decision.reward, decision.effects, ended = step.reward, step.effects, step.ended
            decisions.append(decision)
            recognition.observe(step.effects)
            effects += step.effects
            if task.moved is not None:
                shared.moves.update_trajectory([task.moved[0]], [task.moved[1]])
        lived.returns.append(sum(decision.reward for decision in decisions))
        lived.decisions.append(decisions)

    # Notice and learn: a new type, or more of a known one.
    lived.alarm, lived.alarm_score = recognition.alarmed, recognition.highest
    number: int | None = None
    belief = recognition.belief[:-1]
    if not abilities.reuse and n_types:
        number = 0
        knowledge.types.teach(number, effects)
    elif lived.alarm:
        number = knowledge.types.add(name, effects)
        belief = np.zeros(n_types + 1)
        belief[number] = 1.0
    else:
        belief = belief / belief.sum()
        if belief.max() >= settings.sure:
            number = int(belief.argmax())
            knowledge.types.teach(number, effects)
    lived.learnt = None if number is None else knowledge.types.types[number].name

    # Remember: the best acts here, the types of this context, and how often each cause comes up.
    laws = knowledge.types.laws(recognition.own)
    contexts, best = task.best_acts(laws[-1 if number is None else number], shared)
    shared.acts.update(contexts, best)
    if abilities.reuse:
        knowledge.sight(drawn.context, belief, drawn.number)
    knowledge.count_causes(effects)
    return lived


def decide(
    knowledge: Knowledge,
    task: AgentTask,
    recognition: Recognition,
    generator: np.random.Generator | None = None,
    trying: bool = False,
) -> Decision:
    """The act of the behaviour that is worth most under the belief; with a generator, under laws drawn from it.

    Drawn laws (posterior sampling) try acts as often as they may be the best ones. With `trying` the agent does not
    give up.
    """
    laws = knowledge.types.laws(recognition.own, generator)
    tried = knowledge.types.tried(recognition.own)
    plan: Plan = task.plan(laws, tried, len(laws) - 1, knowledge.shared)
    belief = recognition.belief
    expected = belief @ plan.values
    behaviour = int(expected.argmax())
    act = plan.trying[behaviour] if trying else plan.acts[behaviour]
    return Decision(int(act), behaviour, belief, expected, task.describe())
