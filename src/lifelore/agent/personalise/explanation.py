"""The evidence behind the belief about a user of a study: why the next policy is likely to be chosen."""

from collections import deque
from contextlib import suppress
from typing import Any

import numpy as np

from lifelore.agent.personalise.beliefs import probabilities, start_at_priors, unknown_probability
from lifelore.agent.personalise.identifiers import identifier
from lifelore.agent.personalise.study import Study, known_users
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.reuse.explanation import MAX_EVIDENCE, Evidence, relative_evidence
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name
from lifelore.memory.study_rows import DecisionRow, UserRow

LAST_DECISIONS = 16
"""Number of last decisions in an explanation."""


def explain(memory: Memory, study: Study, user: str) -> dict[str, Any]:
    """What memory knows of a user and how that leads to the next choice; nothing is stored.

    Returns
    -------
    dict
        ``user``, ``study``; ``decisions`` so far, ``open`` ones without an outcome; ``control``; ``context`` and
        ``features`` as stored; ``belief`` by type, most likely first, as if one of these fitted; ``novelty``, the
        probability that none fits (None where it is not computed); ``expected`` outcome and ``probabilities`` of
        the next choice by policy in use (of the control group: None); ``surprise`` of the outcomes in nats (the
        sum of −log evidence; it depends on the noise, and is no sign of a new type); ``evidence``: for
        each of the last outcomes its ``policy``, ``log_evidence``, and by type the log likelihood less that of the
        best type (None: impossible); ``last``: the last decisions with their logged probability and outcome.

    Raises
    ------
    NotFoundError
        Nothing is stored of the user.
    """
    known, decisions, shown = _read(memory, study, user)
    algorithm = study.algorithm.new_rows(1)
    start_at_priors(algorithm, study, [known])
    evidence: deque[Evidence] = deque(maxlen=MAX_EVIDENCE)
    surprise = 0.0
    for policy, outcome in shown:
        if policy in study.library.policies:
            number = study.library.index_of_policy(policy)
            found = algorithm.observe(0, number, outcome)
            evidence.append(Evidence(number, found.log_likelihood, float(found.log_evidence)))
            surprise += evidence[-1].surprise
        algorithm.end_episode(0)
    odds = probabilities(study, algorithm, np.zeros(1, np.int64))[0]
    belief = algorithm.belief(0)
    expected = algorithm.known(0).performance.expected(belief)[study.active_numbers]
    relative, novelty = relative_evidence(list(evidence), study.library.n_types), None
    with suppress(InputError):  # there is no broad type for such signals
        novelty = _novelty(study, known, shown)
    return {
        "study": study.name,
        "user": user,
        "decisions": len(decisions),
        "open": sum(one.outcome is None for one in decisions),
        "control": study.holds_out(user),
        "context": known.context,
        "features": known.features,
        "belief": _by_name(study.library.types, belief),
        "expected": _by_name(tuple(study.active), expected),
        "probabilities": None if study.holds_out(user) else _by_name(tuple(study.active), odds),
        "surprise": surprise,
        "novelty": novelty,
        "evidence": [
            {
                "policy": study.library.policies[one.policy],
                "log_evidence": _finite(one.log_evidence),
                "types": {name: _finite(value) for name, value in zip(study.library.types, row, strict=True)},
            }
            for one, row in zip(evidence, relative.tolist(), strict=True)
        ],
        "last": [_described(one) for one in decisions[-LAST_DECISIONS:]],
    }


def stranger_table(study: Study) -> dict[str, Any]:
    """Probabilities of the policies in use for users of whom nothing but the context is known.

    Returns
    -------
    dict
        ``study``, ``version``; ``default``, of users without a known context, and ``contexts``, each by policy.
    """
    contexts = [None, *study.contexts]
    algorithm = study.algorithm.new_rows(len(contexts))
    strangers = [UserRow(0, "", context, None, None, False, study.version, None) for context in contexts]
    start_at_priors(algorithm, study, strangers)
    found = probabilities(study, algorithm, np.arange(len(contexts)))
    tables = [dict(zip(study.active, row, strict=True)) for row in found.tolist()]
    by_context = dict(zip(study.contexts, tables[1:], strict=True))
    return {"study": study.name, "version": study.version, "default": tables[0], "contexts": by_context}


def novelty_of(memory: Memory, study: Study, user: str) -> float:
    """The probability that no type of the library fits a user; InputError where no broad law is known."""
    known, _, shown = _read(memory, study, user)
    return _novelty(study, known, shown)


def _novelty(study: Study, known: UserRow, shown: list[tuple[str, float]]) -> float:
    return float(unknown_probability(study, [known], [(known.number, *pair) for pair in shown])[0])


def _read(memory: Memory, study: Study, user: str) -> tuple[UserRow, list[DecisionRow], list[tuple[str, float]]]:
    """A user, the decisions, and (policy, outcome) of all that the belief follows from."""
    check_name("user", user)
    with memory.studies.reading(study.number) as rows:
        known = known_users(rows, study, [user]).get(user)
        if known is None:
            raise NotFoundError(f"nothing is stored of user '{user}' in study '{study.name}'")
        evidence = rows.evidence([known.number])
        decisions = rows.decisions_of([known.number]).get(known.number, [])
    return known, decisions, [(policy, outcome) for _, policy, outcome in evidence]


def _described(decision: DecisionRow) -> dict[str, Any]:
    return {
        "decision": identifier(decision.id),
        "policy": decision.policy,
        "probability": decision.probability,
        "control": decision.control,
        "outcome": decision.outcome,
        "chosen": decision.time / 1000,
        "available": None if decision.available is None else list(decision.available),
    }


def _by_name(names: tuple[str, ...], values: np.ndarray) -> dict[str, float]:
    order = np.argsort(-values, kind="stable").tolist()
    return {names[place]: float(values[place]) for place in order}


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
