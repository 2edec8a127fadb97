"""The evidence behind the belief about a user of a study: why the next policy is likely to be chosen."""

from typing import Any

import numpy as np

from lifelore.agent.reuse.history import read_decisions, user_key
from lifelore.agent.reuse.log_columns import check_word
from lifelore.agent.reuse.one_user import policy_odds
from lifelore.agent.reuse.study import Study
from lifelore.agent.reuse.user_belief import belief_anew, open_belief
from lifelore.core.errors import NotFoundError
from lifelore.interaction.reuse.explanation import relative_evidence
from lifelore.memory import Memory

LAST_DECISIONS = 16
"""Number of last decisions in an explanation."""


def explain(memory: Memory, study: Study, user: str) -> dict[str, Any]:
    """What memory knows of a user and how that leads to the next choice; nothing is stored.

    Returns
    -------
    dict
        ``user``, ``study``; ``decisions`` so far, ``open`` ones without an outcome; ``control``; ``context`` and
        ``features`` as stored; ``belief`` by type, most likely first; ``expected`` outcome and ``probabilities``
        of the next choice by policy in use (of the control group: None); ``surprise`` in nats; ``evidence``: for
        each of the last outcomes its ``policy``, ``log_evidence``, and by type the log likelihood less that of the
        best type (None: impossible); ``last``: the last decisions with their logged probability and outcome.

    Raises
    ------
    NotFoundError
        Nothing is stored of the user.
    """
    check_word("user", user)
    key = user_key(study.name, user)
    known = open_belief(memory, study, key, user)
    now = belief_anew(memory, study, known)
    last = list(now.evidence)
    number = known.state.head.number
    if number == 0 and not last:
        raise NotFoundError(f"nothing is stored of user '{user}' in study '{study.name}'")
    odds = None if study.holds_out(user) else policy_odds(study, now)
    recent = read_decisions(memory, study, key, max(0, number - LAST_DECISIONS))
    relative = relative_evidence(last, study.library.n_types)
    return {
        "study": study.name,
        "user": user,
        "decisions": number,
        "open": sum(one.outcome is None for one in read_decisions(memory, study, key, known.state.first_open)),
        "control": study.holds_out(user),
        "context": known.context,
        "features": known.features,
        "belief": _by_name(study.library.types, now.belief),
        "expected": _by_name(tuple(study.active), now.expected[study.active_numbers]),
        "probabilities": None if odds is None else _by_name(tuple(odds.policies), odds.probs),
        "surprise": known.state.head.surprise,
        "evidence": [
            {
                "policy": study.library.policies[one.policy],
                "log_evidence": _finite(one.log_evidence),
                "types": {name: _finite(value) for name, value in zip(study.library.types, row, strict=True)},
            }
            for one, row in zip(last, relative.tolist(), strict=True)
        ],
        "last": [
            {
                "decision": known.history.identifier(one),
                "policy": one.policy,
                "probability": one.probability,
                "control": one.control,
                "outcome": one.outcome,
                "chosen": one.chosen,
                "available": None if one.available is None else list(one.available),
            }
            for one in recent
        ],
    }


def _by_name(names: tuple[str, ...], values: np.ndarray) -> dict[str, float]:
    order = np.argsort(-values, kind="stable").tolist()
    return {names[place]: float(values[place]) for place in order}


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
