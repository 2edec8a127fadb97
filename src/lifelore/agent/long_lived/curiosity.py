"""What the agent would rather learn next: contexts by entropy × frequency, types by what is unknown of them.

High entropy of the types in a context has several causes (thesis §3.3.2, §5.2):

    H[P(τ | c)] = mutual information (tasks disagree) + mean H of the tasks' beliefs (types never made out)
                + what is left of the prior's own doubt (too few tasks were seen there)

Tasks that disagree stay so however much is seen; the other two fall with more episodes.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.types.type_prior import TypePrior
from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy


@dataclass(frozen=True)
class CuriousContext:
    """A context, and why the agent is curious about it.

    Parameters
    ----------
    context : int or hashable
        Its code, or as it was given.
    entropy : float
        Of the prior over types for the next task there, nats.
    frequency : float
        Share of all tasks.
    disagreement : float
        Part of the entropy that stays if every task's type is known, nats.
    """

    context: Any
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


def curious_contexts(prior: TypePrior) -> list[CuriousContext]:
    """Contexts that were met, the most interesting first."""
    beliefs: dict[int, list[np.ndarray]] = {}
    for date in sorted(prior.dates):
        for context, belief in prior.dates[date].items():
            beliefs.setdefault(context, []).append(belief)
    today, found = max(prior.dates, default=0) + 1, []
    n_tasks = sum(map(len, beliefs.values()))
    for context, tasks in beliefs.items():
        rows = np.array(tasks)
        rows /= rows.sum(axis=1, keepdims=True)
        doubt = float(entropy(prior.prior(context, today)[None])[0])
        shared = float(entropy(rows.mean(axis=0)[None])[0] - entropy(rows).mean())
        found.append(CuriousContext(context, doubt, len(rows) / n_tasks, min(doubt, max(0.0, shared))))
    return sorted(found, key=lambda one: (-one.interest, one.context))


def context_to_practise(knowledge: Knowledge, generator: np.random.Generator) -> int:
    """A context for a task in spare time, drawn in proportion to its interest.

    Raises
    ------
    InputError
        No context was met yet.
    """
    found = curious_contexts(knowledge.type_prior())
    if not found:
        raise InputError("a context to practise needs tasks that were lived; live through some first")
    # Where nothing is in doubt, often met contexts are practised.
    weights = np.array([one.interest + 1e-9 * one.frequency for one in found])
    return found[int(generator.choice(len(found), p=weights / weights.sum()))].context


def curious_types(knowledge: Knowledge) -> list[CuriousType]:
    """Types by what they have not shown, the least known first."""
    known, causes = knowledge.known_types(), np.arange(knowledge.family.n_causes)
    frequency = knowledge.shared.causes.counts(causes)[:, 0]
    found = []
    for number, one in enumerate(known.types):
        shown = known.counts[number].any(axis=1)
        untried = float(frequency[~shown].sum() / max(frequency.sum(), 1e-300))
        sightings = [knowledge.types[name].sightings for name in one.members]
        n_tasks = sum(float(seen.counts(seen.contexts).sum()) for seen in sightings)
        found.append(CuriousType(one.name, untried, n_tasks))
    return sorted(found, key=lambda one: (-one.untried, one.name))
