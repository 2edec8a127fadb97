"""What a memory knows of tasks with hidden types: the types, what it expects by context, and its curiosity."""

from typing import Any

import numpy as np

from lifelore.agent.long_lived.curiosity import CuriousContext, curious_contexts, curious_types
from lifelore.agent.long_lived.explanation import type_words
from lifelore.agent.long_lived.families.by_name import family_named
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.long_life import recalled
from lifelore.memory import Memory

TELLING_CAUSES = 6
"""Number of causes that describe a type, those in which it differs most from the others."""


def known_family(memory: Memory, domain: str, seed: int = 0) -> dict[str, Any]:
    """The knowledge of all robots of a memory about a family.

    Parameters
    ----------
    memory : Memory
    domain : str
        A name of `families.by_name.FAMILIES`.
    seed : int
        Seed of the world in which the tasks were lived.

    Returns
    -------
    dict
        ``tasks``, the number of tasks that taught; ``types``, the least known first: ``name``, ``tasks`` behind
        it, ``untried`` (see `curiosity.CuriousType`) and ``telling``, lines about what it does unlike others;
        ``contexts``, the most interesting first: ``context``, ``tasks``, ``expected`` (probability of each type
        in the next task, by name), ``entropy``, ``unsure``, ``disagreement`` in nats, ``frequency`` and
        ``interest`` (see `curiosity.CuriousContext`).

    Raises
    ------
    NotFoundError
        No family has this name.
    """
    knowledge = recalled(family_named(domain, seed), memory)
    if not knowledge.types:
        return {"tasks": 0, "types": [], "contexts": []}
    telling = _telling(knowledge)
    types = [
        {
            "name": type_words(one.name),
            "tasks": round(one.n_tasks, 2),
            "untried": round(one.untried, 4),
            "telling": telling[one.name],
        }
        for one in curious_types(knowledge)
    ]
    return {"tasks": knowledge.n_tasks, "types": types, "contexts": _contexts(knowledge)}


def _contexts(knowledge: Knowledge) -> list[dict[str, Any]]:
    names = [type_words(one.name) for one in knowledge.known_types().types]
    prior = knowledge.type_prior()
    today = max(prior.dates)

    def entry(one: CuriousContext) -> dict[str, Any]:
        expected = prior.prior(one.context, today)
        return {
            "context": one.context,
            "tasks": sum(one.context in seen for seen in prior.dates.values()),
            "expected": {name: round(float(p), 4) for name, p in zip(names, expected, strict=True)},
            "entropy": abs(round(one.entropy, 4)),
            "unsure": round(one.unsure, 4),
            "disagreement": round(one.disagreement, 4),
            "frequency": round(one.frequency, 4),
            "interest": abs(round(one.interest, 4)),
        }

    return [entry(one) for one in curious_contexts(prior)]


def _telling(knowledge: Knowledge) -> dict[str, list[str]]:
    """Lines about the causes in which a type differs most from what all types have in common."""
    known, family = knowledge.known_types(), knowledge.family
    laws = known.laws(np.zeros((family.n_causes, family.n_effects)))[:-1]
    judged = known.judged
    lines = {}
    for one, law in zip(known.types, laws, strict=True):
        apart = np.abs(law[judged] - known.pooled[judged]).max(axis=1, initial=0.0)
        most = judged[np.argsort(-apart, kind="stable")[:TELLING_CAUSES]]
        lines[one.name] = [
            f"{family.cause_name(cause)}: {family.effect_name(cause, effect)} ({100 * law[cause, effect]:.0f} %)"
            for cause, effect in ((int(c), int(law[c].argmax())) for c in most)
        ]
    return lines
