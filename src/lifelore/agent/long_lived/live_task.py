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

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.check_family import checked_plan, checked_step
from lifelore.agent.long_lived.knowledge import Knowledge, TaskNews
from lifelore.agent.long_lived.known_types import Effects, KnownTypes
from lifelore.agent.long_lived.recognition import Recognition
from lifelore.agent.long_lived.task_family import Abilities, AgentTask
from lifelore.agent.long_lived.task_log import Decision, TaskLog
from lifelore.core.streams import stream
from lifelore.domains.task_stream import DrawnTask

Array = NDArray[np.float64]

UNKNOWN = 0.05
"""Prior probability that no known type fits."""


def live_task(
    knowledge: Knowledge,
    drawn: DrawnTask,
    task: AgentTask,
    abilities: Abilities,
    name: str,
    *,
    n_episodes: int = 8,
    false_alarm: float = 0.05,
    seed: int = 0,
) -> tuple[TaskLog, TaskNews]:
    """Live through a task.

    Parameters
    ----------
    knowledge : Knowledge
        Only read.
    drawn : DrawnTask
        Its context is observed; its hidden type is only copied into the result.
    task : AgentTask
    abilities : Abilities
    name : str
        Of the new type, if the task has one; unique in the fleet.
    n_episodes : int
        Number of episodes of a task, at least 1.
    false_alarm : float
        Probability of an alarm in a task of a known type, in (0, 1).
    seed : int

    Returns
    -------
    (TaskLog, TaskNews)
        What happened, and what `Knowledge.learn` takes in.
    """
    known, shared = knowledge.known_types(), knowledge.shared
    lived = TaskLog(drawn, types=[one.name for one in known.types])

    # Recognise: which types does this context usually have?
    lived.prior = np.full(len(known), 1 / max(len(known), 1))
    if abilities.prior and len(known):
        lived.prior = knowledge.type_prior().prior(drawn.context, drawn.number)
    recognition = Recognition(knowledge, lived.prior, false_alarm, UNKNOWN, seed)
    shared.guided = abilities.prior

    # Act: perceive, reuse the behaviours of the known types, and let every effect tell more of the type.
    effects: list[tuple[int, int]] = []
    for episode in range(n_episodes):
        task.begin()
        between = 0 < episode < n_episodes - 1
        decisions, ended = [], False
        while not ended:
            generator = stream(seed, "long-lived", "episode", drawn.number, episode) if between else None
            decision = decide(knowledge, task, recognition, generator, trying=between and not decisions)
            step = checked_step(knowledge.family, decision.act, task.act(decision.act))
            decision.reward, decision.effects, ended = step.reward, step.effects, step.ended
            decisions.append(decision)
            recognition.observe(step.effects)
            effects += step.effects
        lived.returns.append(sum(decision.reward for decision in decisions))
        lived.decisions.append(decisions)

    # Notice: does any known type fit?
    lived.alarm, lived.alarm_score = recognition.alarmed, recognition.highest
    belief = _learning(recognition, effects, name, abilities)
    lived.learnt = max(belief, key=belief.__getitem__)

    # Learn and remember: types learn the effects as far as they are believed, contexts their best acts and types.
    row = _row(known, lived.learnt)
    contexts, best = task.best_acts(known.laws(recognition.own)[row], shared)
    return lived, TaskNews(drawn.context, drawn.number, belief, effects, contexts, best)


def _learning(recognition: Recognition, effects: Effects, name: str, abilities: Abilities) -> dict[str, float]:
    """How much each type, by name, learns from the effects of a task; a type that is new has the given name."""
    known, belief = recognition.known, recognition.belief
    believed = belief[:-1] / max(float(belief[:-1].sum()), 1e-300)
    fits = len(known) > 0 and not recognition.alarmed and not known.differs(int(believed.argmax()), effects)
    if not fits and (abilities.reuse or not len(known)):
        return {name: 1.0}
    believed = believed if abilities.reuse else np.ones(1)
    return {one.members[0]: value for one, value in zip(known.types, believed.tolist(), strict=True)}


def _row(known: KnownTypes, name: str) -> int:
    """The row of a type, by the name of its first member, in `KnownTypes.laws`; the last of a new one."""
    return next((row for row, one in enumerate(known.types) if one.members[0] == name), len(known))


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
    plan = checked_plan(known.family, task.plan(laws, tried, len(laws) - 1, knowledge.shared), len(laws))
    belief = recognition.belief
    expected = belief @ plan.values
    behaviour = int(expected.argmax())
    act = plan.trying[behaviour] if trying else plan.acts[behaviour]
    return Decision(int(act), behaviour, belief, expected, task.describe())
