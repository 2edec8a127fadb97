"""A life of factory orders in which a type arrives late: is it noticed, learnt and recognised?

Alarms in tasks of types that the agent has met in two tasks or more are false. The area under the curve (AUC) is
the probability that the alarm's score of the late type's first task is above that of a known type's task.
"""

from collections import Counter
from dataclasses import dataclass

import numpy as np

from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.agent.long_lived.task_log import TaskLog
from lifelore.domains.factory.customer_orders import CUSTOMERS
from lifelore.domains.task_stream import TaskStream

LIVING = LivingSettings(n_episodes=15, false_alarm=0.05)
MET = 2
"""Tasks of a type after which it counts as known."""
SOON = 5
"""Episodes within which a type that has been learnt should be recognised."""
RECOGNISED = 0.5
"""Belief in the learnt type at which it is recognised."""


@dataclass(frozen=True)
class LateTypeLife:
    """A life with a late type.

    known_scores, late_scores : list of float
        Largest score of the alarm in tasks of known types before the arrival, and in the late type's first task.
    false_alarms : list of bool
        In tasks of known types, of the whole life.
    noticed, learnt : bool
        Whether the late type raised an alarm in its first task, and whether it became a type of its own there.
    recognised_after : int or None
        Episodes of its second task until the belief in the learnt type reaches `RECOGNISED`; None: never, or there
        was no second task.
    again : bool
        Whether there was a second task.
    """

    known_scores: list[float]
    late_scores: list[float]
    false_alarms: list[bool]
    noticed: bool
    learnt: bool
    recognised_after: int | None
    again: bool


def live_with_late_type(life: int, n_tasks: int, arrival: int) -> LateTypeLife:
    """Live through orders; the late type is drawn by the number of the life."""
    types = tuple(CUSTOMERS)
    late = types[life % len(types)]
    family = FactoryFamily(TaskStream(types, life, len(types), arrivals={late: arrival}), life)
    knowledge, abilities = Knowledge.empty(family), AGENTS["full"]
    met: Counter[str] = Counter()
    known, false, first, second = [], [], None, None
    for number in range(n_tasks):
        drawn, task = family.meet(number, abilities)
        lived, _ = live_task(knowledge, drawn, task, abilities, LIVING, f"agent.{number}", life)
        hidden = drawn.hidden_type
        if hidden == late:
            first, second = (lived, second) if first is None else (first, second or lived)
        elif met[hidden] >= MET:
            false.append(lived.alarm)
            if number < arrival:
                known.append(lived.alarm_score)
        met[hidden] += 1
    assert first is not None, "the late type arrives"
    recognised = None if second is None else _recognised_after(second, first.learnt)
    own = first.learnt == f"agent.{first.drawn.number}"
    return LateTypeLife(known, [first.alarm_score], false, first.alarm, own, recognised, second is not None)


def _recognised_after(lived: TaskLog, name: str) -> int | None:
    rows = [row for row, joined in enumerate(lived.types) if name in joined.split("+")]
    for episode, decisions in enumerate(lived.decisions):
        if any(decision.belief[rows].sum() >= RECOGNISED for decision in decisions):
            return episode + 1
    return None


def auc(low: list[float], high: list[float]) -> float:
    """Probability that a draw of `high` exceeds a draw of `low`; ties count half.

    Examples
    --------
    >>> auc([0.0, 1.0], [1.0, 2.0])
    0.875
    """
    difference = np.subtract.outer(np.array(high), np.array(low))
    return float((np.sign(difference) / 2 + 0.5).mean())
