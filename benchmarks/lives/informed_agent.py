"""The informed agent of tabletop lives: what true relations and known outcomes allow without a simulator.

It plans as the long-lived agent does. But it is told the hidden type; it sees which object carries which; and its
laws are the outcomes of a life that it has lived on the same tasks before, by true type. It still does not know
what an act will do to this very tray, as the best possible return does.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.tabletop import TabletopFamily
from lifelore.agent.long_lived.families.tabletop_task import TabletopTask
from lifelore.agent.long_lived.families.tray_features import PerceivedTray, look_with_labels
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.known_types import KnownType, KnownTypes, effect_counts
from lifelore.agent.long_lived.live_task import decide
from lifelore.core.streams import stream
from lifelore.domains.tabletop.truth import SHARE, bearing
from lifelore.domains.tabletop_job.job import TabletopJob

Array = NDArray[np.float64]


class ToldType:
    """What stands for recognition where the type is told.

    Parameters
    ----------
    known : KnownTypes
    row : int
        The type of the task.
    """

    def __init__(self, known: KnownTypes, row: int) -> None:
        self.known = known
        self.own = np.zeros((known.family.n_causes, known.family.n_effects))
        self.belief = np.eye(len(known) + 1)[row]


def carried_shares(job: TabletopJob) -> Array:
    """Share of each object's weight (row) that each other object (column) carries now, (n, n)."""
    return np.maximum(bearing(*job.contacts()).lift[:-1, :-1], 0)


def look_at_true_relations(job: TabletopJob) -> PerceivedTray | None:
    """The tray with true relations: an object lies on whatever carries part of its weight."""
    seen = look_with_labels(job)
    if seen is None:
        return None
    carried = carried_shares(job)
    pairs = {(a, b): 1.0 for a in seen.objects for b in seen.objects if a != b and carried[a, b] > SHARE}
    return replace(seen, carries=pairs)


def informed_returns(family: TabletopFamily, n_tasks: int, n_episodes: int, seed: int) -> Array:
    """Returns of first episodes (n_tasks,), after a life on the same tasks that is told their types."""
    known = KnownTypes(family, [KnownType.empty(family, name) for name in family.stream.types])
    for number in range(n_tasks):
        _, effects = _episodes(family, known, number, n_episodes, seed)
        row = family.stream.types.index(family.stream.draw(number).hidden_type)
        known.types[row].effects.merge(effect_counts(family, effects))
        known.forget_laws()
    return np.array([_episodes(family, known, number, 1, seed)[0] for number in range(n_tasks)])


def _episodes(
    family: TabletopFamily, known: KnownTypes, number: int, n_episodes: int, seed: int
) -> tuple[float, list[tuple[int, int]]]:
    """Return of the first episode of a task, and the effects of all its episodes."""
    drawn, job = family.job(number)
    task, knowledge = TabletopTask(job, look_at_true_relations), Knowledge.empty(family)
    told = ToldType(known, family.stream.types.index(drawn.hidden_type))
    first, effects = 0.0, list[tuple[int, int]]()
    for episode in range(n_episodes):
        task.begin()
        ended, between = False, 0 < episode < n_episodes - 1
        trying = between
        while not ended:
            generator = stream(seed, "informed agent", number, episode) if between else None
            step = task.act(decide(knowledge, task, told, generator, trying).act)
            trying, ended = False, step.ended
            for effect in step.effects:
                told.own[effect] += 1
            effects += step.effects
            first += step.reward if episode == 0 else 0.0
    return first, effects
