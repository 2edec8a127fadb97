"""The verbs `reuse choose`, `update`, `retire`, `add` and `forget`: one user at a time, kept as it happens.

Each is one transaction of memory: after a crash at any moment a decision or an outcome is there as a whole or
not at all. Every function takes the study as `open_study` gave it, so that a loop opens it once.
"""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.history import (
    Decision,
    History,
    open_history,
    parse_identifier,
    replayed,
    robot_of,
    user_key,
)
from lifelore.agent.reuse.log import check_word
from lifelore.agent.reuse.study import ACTIVE, PILOT, RETIRED, Study
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.belief import expected_utility
from lifelore.memory import Memory

ATTEMPTS = 1000
"""Times that a decision is offered to memory: others may choose for the same user at the same moment."""


@dataclass(frozen=True, eq=False)
class _Odds:
    """Policies that may be chosen, and how likely each is."""

    policies: list[str]
    probs: NDArray[np.float64]


def choose(
    memory: Memory, study: Study, user: str, *, context: str | None = None, seed: int = 0
) -> dict[str, Any]:
    """Choose a policy for a user's next time and remember that it was chosen.

    Parameters
    ----------
    user : str
    context : str, optional
        What is known of the user beforehand; kept, the newest one counts.
    seed : int
        The draw depends on the seed, the study, the user and the number of the decision alone.

    Returns
    -------
    dict
        ``user``, ``policy``, ``decision`` (to give the outcome by), ``number`` (from 0), ``probability`` of the
        policy at this moment, ``control``, ``context`` whose prior counts (None: everybody's), ``belief`` by type,
        ``expected`` outcome by active policy, ``surprise`` of the outcomes so far in nats.

    Raises
    ------
    InputError
        A name that is no printable text.
    """
    check_word("user", user)
    if context is not None:
        check_word("context", context)
    key, attempt = user_key(study.name, user), 0
    for _ in range(ATTEMPTS):
        known = open_history(memory, study, key, user)
        history = History(known.study, key, user, context or known.context, known.decisions)
        decision, answer = _decided(study, history, attempt, seed)
        offered = [history.record_of(decision)]
        process = _process(decision)
        task = {"study": study.name, "policy": decision.policy}
        if memory.contribute(history.robot, offered, process=process, seq=0, task=task):
            return answer
        # Another process took this number, or a forgotten decision had it.
        again = len(open_history(memory, study, key).decisions) == len(known.decisions)
        attempt = attempt + 1 if again else 0
    raise StoreError(f"memory {memory.location}: too many choices for one user at once; try again")


def _decided(study: Study, history: History, attempt: int, seed: int) -> tuple[Decision, dict[str, Any]]:
    agent = replayed(study, history)
    belief = agent.belief
    control = study.holds_out(history.user)
    odds = _control_odds(study) if control else _odds(study, belief)
    number = history.decisions[-1].number + 1 if history.decisions else 0
    drawn = stream(seed, "reuse choice", study.name, history.user, number).choice(len(odds.probs), p=odds.probs)
    policy, probability = odds.policies[drawn], float(odds.probs[drawn])
    decision = Decision(number, policy, probability, control, int(time.time()), attempt)
    expected = expected_utility(belief, study.choice_of.performance.mean)
    answer = {
        "user": history.user,
        "policy": policy,
        "decision": history.identifier(decision),
        "number": number,
        "probability": probability,
        "control": control,
        "context": history.context if history.context in study.contexts else None,
        "belief": dict(zip(study.library.types, belief.tolist(), strict=True)),
        "expected": dict(zip(study.active, expected.tolist(), strict=True)),
        "surprise": agent.surprise,
    }
    return decision, answer


def _odds(study: Study, belief: NDArray[np.float64]) -> _Odds:
    """What the rule does, and a share of anything."""
    probs = study.selection.probabilities(study.choice_of, belief)
    probs = (1 - study.explore) * probs + study.explore / len(probs)
    return _Odds(study.active, probs / probs.sum())


def _control_odds(study: Study) -> _Odds:
    """The incumbent, or every policy in use alike, pilots too."""
    policies = [study.incumbent] if study.incumbent is not None else [*study.active, *study.pilots]
    return _Odds(policies, np.full(len(policies), 1 / len(policies)))


def update(memory: Memory, study: Study, decision: str, outcome: float) -> dict[str, Any]:
    """Take in how a decision ended, once, however late.

    Returns
    -------
    dict
        ``decision``, ``user``, ``policy``, ``outcome``; ``taken``: False where the same outcome was there already
        and nothing changed; ``belief`` by type after it.

    Raises
    ------
    NotFoundError
        No such decision: never made here, or forgotten.
    InputError
        The outcome is no finite number, none of the values a categorical library knows, or another one was taken.
    """
    key, number, attempt = parse_identifier(decision)
    history = open_history(memory, study, key)
    found = _find(history, number, attempt, decision)
    _check_outcome(study, found, outcome)
    record = history.outcome_record(found, outcome, int(time.time()))
    task = {"study": study.name, "outcome": outcome}
    taken = found.outcome is None and memory.contribute(
        history.robot, [record], process=_process(found), seq=1, task=task
    )
    history = open_history(memory, study, key)
    kept = _find(history, number, attempt, decision)
    if kept.outcome != outcome:
        raise InputError(
            f"decision {decision} ended with {kept.outcome:g} already, got {outcome:g}; nothing changed"
        )
    belief = replayed(study, history).belief
    return {
        "decision": decision,
        "user": history.user,
        "policy": kept.policy,
        "outcome": outcome,
        "taken": taken,
        "belief": dict(zip(study.library.types, belief.tolist(), strict=True)),
    }


def _find(history: History, number: int, attempt: int, identifier: str) -> Decision:
    for decision in history.decisions:
        if (decision.number, decision.attempt) == (number, attempt):
            return decision
    raise NotFoundError(f"no decision {identifier} in study '{history.study}': never made here, or forgotten")


def _check_outcome(study: Study, decision: Decision, outcome: float) -> None:
    if not np.isfinite(outcome):
        raise InputError(f"outcome must be a finite number, got {outcome}")
    if decision.policy not in study.library.policies or study.library.performance.kind != "categorical":  # type: ignore[attr-defined]
        return
    column = study.library.index_of_policy(decision.policy)
    if np.isneginf(study.library.performance.log_density(column, outcome)).all():
        values = ", ".join(f"{value:g}" for value in study.library.performance.values)  # type: ignore[attr-defined]
        raise InputError(f"outcome must be one of {values}, got {outcome:g}; fit again from a log that has it")


def _process(decision: Decision) -> str:
    return f"{decision.number}.{decision.attempt}"


def retire(memory: Memory, study: Study, policy: str) -> Study:
    """Give a policy to nobody from now on; what it achieved stays evidence.

    Raises
    ------
    NotFoundError
        There is no such policy.
    InputError
        It is the incumbent, or the last one.
    """
    if policy not in study.states:
        raise NotFoundError(f"no policy '{policy}'; there are {', '.join(sorted(study.states))}")
    if policy == study.incumbent:
        raise InputError(f"'{policy}' is the incumbent that the control group gets; fit with another one first")
    if study.active == [policy]:
        raise InputError(f"'{policy}' is the last policy in use; add another one first")
    return _kept(memory, study.with_state(policy, RETIRED))


def add(memory: Memory, study: Study, policy: str) -> Study:
    """Bring a policy in: a retired one as it was, a new one to the control group until a fit knows it.

    Raises
    ------
    InputError
        It is there already; or it is new and there is no control group that draws at random.
    """
    check_word("policy", policy)
    state = study.states.get(policy)
    if state in (ACTIVE, PILOT):
        raise InputError(f"'{policy}' is there already ({state})")
    if policy in study.library.policies:
        return _kept(memory, study.with_state(policy, ACTIVE))
    if not study.control or study.incumbent is not None:
        raise InputError(
            f"'{policy}' has no outcome yet, and there is no control group that gets policies at random: fit from "
            "a log that has it, or with --control and no incumbent"
        )
    return _kept(memory, study.with_state(policy, PILOT))


def _kept(memory: Memory, study: Study) -> Study:
    study.keep(memory)
    return study


def forget(memory: Memory, study: Study, user: str) -> int:
    """Forget a user's decisions, outcomes and belief for good; the number of contributions removed.

    The library still contains the outcomes of the log: remove the user's lines from it and fit again.

    Raises
    ------
    NotFoundError
        Nothing is known of the user.
    """
    key = user_key(study.name, user)
    if not open_history(memory, study, key).decisions:
        raise NotFoundError(
            f"nothing is kept of user '{user}' in study '{study.name}'; lines of the log are in the log alone"
        )
    return memory.forget(robot_of(study.name, key))
