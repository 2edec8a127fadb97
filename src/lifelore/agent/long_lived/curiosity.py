"""What the agent would rather learn next: contexts by entropy × frequency, types by what is unknown of them.

High entropy of the types in a context has two causes (thesis §3.3.2, §5.2): tasks of the context disagree, or
their types were never made out. The first stays however much is seen, the second falls with more episodes:

    H[P(τ | c)] = mean H of the tasks' beliefs (never made out) + mutual information (tasks disagree)
"""

from dataclasses import dataclass

import numpy as np

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.core.metrics import entropy


@dataclass(frozen=True)
class CuriousContext:
    """A context, and why the agent is curious about it.

    Parameters
    ----------
    context : int
    entropy : float
        Of the prior over types, nats.
    frequency : float
        Share of all tasks.
    disagreement : float
        Part of the entropy that stays if every task's type is known, nats.
    """

    context: int
    entropy: float
    frequency: float
    disagreement: float

    @property
    def interest(self) -> float:
        """Entropy × frequency."""
        return self.entropy * self.frequency

    @property
    def unsure(self) -> float:
        """Part of the entropy that more episodes or better features would remove, nats."""
        return max(0.0, self.entropy - self.disagreement)


@dataclass(frozen=True)
class CuriousType:
    """A type, and how little is known of it.

    Parameters
    ----------
    name : str
    untried : float
        Share of the causes that usual tasks show, weighted by how often they do, that this type has not shown.
    n_tasks : float
        Tasks behind it, by belief.
    """

    name: str
    untried: float
    n_tasks: float


def curious_contexts(knowledge: Knowledge) -> list[CuriousContext]:
    """Contexts by interest, the most interesting first."""
    beliefs: dict[int, list[np.ndarray]] = {}
    for (_, context), belief in knowledge.sighted().items():
        beliefs.setdefault(context, []).append(belief)
    total = sum(len(tasks) for tasks in beliefs.values())
    found = []
    for context, tasks in beliefs.items():
        rows = np.array(tasks)
        rows /= rows.sum(axis=1, keepdims=True)
        all_of_it = float(entropy(rows.mean(axis=0)[None])[0])
        unsure = float(entropy(rows).mean())
        found.append(CuriousContext(context, all_of_it, len(rows) / total, max(0.0, all_of_it - unsure)))
    return sorted(found, key=lambda one: (-one.interest, one.context))


def curious_types(knowledge: Knowledge) -> list[CuriousType]:
    """Types by what they have not shown, the least known first."""
    known, causes = knowledge.known_types(), np.arange(knowledge.family.n_causes)
    frequency = knowledge.shared.causes.counts(causes)[:, 0]
    found = []
    for number, one in enumerate(known.types):
        shown = known.counts[number].any(axis=1)
        untried = float(frequency[~shown].sum() / max(frequency.sum(), 1e-300))
        codes = one.sightings.contexts
        found.append(CuriousType(one.name, untried, float(one.sightings.counts(codes).sum())))
    return sorted(found, key=lambda one: (-one.untried, one.name))
