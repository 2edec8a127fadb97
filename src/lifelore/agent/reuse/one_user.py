"""The verbs `reuse choose`, `update`, `retire`, `add` and `forget`: one user at a time, stored as it happens.

Each is one transaction of memory, belief included: after a crash at any moment a decision or an outcome is there
as a whole or not at all. The time of a decision does not grow with the number of decisions before it. Every
function takes the study as `open_study` gave it, so that a loop opens it once.
"""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.availability import checked_available
from lifelore.agent.reuse.history import (
    Decision,
    open_history,
    parse_identifier,
    read_decisions,
    robot_of,
    user_key,
)
from lifelore.agent.reuse.log_columns import check_word
from lifelore.agent.reuse.past import forget_past
from lifelore.agent.reuse.requests import request_record, requested
from lifelore.agent.reuse.study import ACTIVE, PILOT, RETIRED, Study
from lifelore.agent.reuse.user_belief import UserBelief, belief_anew, open_belief
from lifelore.agent.reuse.user_state import WorkingBelief
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.streams import stream
from lifelore.interaction.outcomes.outcome_model import LARGEST
from lifelore.interaction.selection.choice import available_mask
from lifelore.memory import KeyState, Memory

ATTEMPTS = 1000
"""Times that a decision is offered to memory: others may choose for the same user at the same moment."""


@dataclass(frozen=True, eq=False)
class Odds:
    """Policies that may be chosen, and how likely each is."""

    policies: list[str]
    probs: NDArray[np.float64]


def choose(
    memory: Memory,
    study: Study,
    user: str,
    *,
    context: str | None = None,
    features: Mapping[str, float] | None = None,
    available: Sequence[str] | None = None,
    seed: int = 0,
    novelty: bool = False,
    request: str | None = None,
) -> dict[str, Any]:
    """Choose a policy for a user's next time and remember that it was chosen.

    Parameters
    ----------
    user : str
    context : str, optional
        What is known of the user beforehand; kept, the newest one counts.
    features : mapping of str to float, optional
        Numbers known of the user beforehand: all features of the study; kept, the newest ones count. They come
        before the context. Without them, and in a study without features, the prior is that of the context.
    available : sequence of str, optional
        The policies that the user can get now; all by default. Retired ones are left out. Where the incumbent is
        not available, the control group gets each available policy with equal probability. The set is stored with
        the decision.
    seed : int
        The draw depends on the seed, the study, the user and the number of the decision alone.
    novelty : bool
        Whether to compute the probability that no type of the library fits the user. The time grows with the
        number of the user's decisions.
    request : str, optional
        Identifier of the request, unique for the user. The same request again gets the decision that it got
        before, and nothing is stored.

    Returns
    -------
    dict
        ``user``, ``policy``, ``decision`` (to give the outcome by), ``number`` (from 0), ``probability`` of the
        policy at this moment, ``available`` policies (None: all), ``control``, ``features`` whose prior counts,
        else ``context`` whose prior counts (both None: everybody's), ``belief`` by type,
        ``expected`` outcome by active policy, ``surprise`` of the outcomes so far in nats (the sum of −log
        evidence; it depends on the noise, and is no sign of a new type), ``novelty``: the probability that no
        type of the library fits the user, as far as it was asked for, else None. With a `request` also
        ``repeated``: whether it was answered before; then belief, context, features and expected outcomes are
        those of now.

    Raises
    ------
    InputError
        A name that is no printable text, no available policy is in use, or a feature is missing.
    NotFoundError
        There is no such policy or feature.
    """
    check_word("user", user)
    if context is not None:
        check_word("context", context)
    if available is not None:
        available = checked_available(study, available)
    numbers = None if features is None else checked_features(study, features)
    key, attempt = user_key(study.name, user), 0
    for _ in range(ATTEMPTS):
        known = open_belief(memory, study, key, user, context, numbers)
        made = None if request is None else requested(memory, study.name, key, request)
        if made is None:
            decision, answer = _decided(study, known, attempt, seed, available)
        else:
            decision, answer = _repeated(memory, study, known, *made)
        unknown = belief_anew(memory, study, known, novelty=True).novelty if novelty else None
        answer["novelty"] = None if unknown is None else unknown.probability
        if request is not None:
            answer["repeated"] = made is not None
        if made is not None:
            return answer
        offered = known.history.records_of(decision)
        if request is not None:
            offered.append(request_record(study.name, key, request, decision.number, decision.attempt))
        task = {"study": study.name, "policy": decision.policy}
        after = known.state.after(study, [decision], known.state.head)
        state = KeyState(known.name, known.token, after.to_bytes())
        process = _process(decision)
        if memory.contribute(known.history.robot, offered, process=process, seq=0, task=task, state=state):
            return answer
        # Another process took this number, or a forgotten decision had it.
        attempt = attempt + 1 if open_belief(memory, study, key).token == known.token else 0
    raise StoreError(f"memory {memory.location}: too many choices for one user at once; try again")


def _decided(
    study: Study, known: UserBelief, attempt: int, seed: int, available: Sequence[str] | None
) -> tuple[Decision, dict[str, Any]]:
    head, user = known.state.head, known.history.user
    control, now = study.holds_out(user), WorkingBelief(study, head)
    odds = _control_odds(study, available) if control else policy_odds(study, now, available)
    drawn = stream(seed, "reuse choice", study.name, user, head.number).choice(len(odds.probs), p=odds.probs)
    policy, probability = odds.policies[drawn], float(odds.probs[drawn])
    among = None if available is None else tuple(available)
    decision = Decision(head.number, policy, probability, control, int(time.time()), attempt, available=among)
    return decision, _answer(study, known, decision, now)


def _repeated(
    memory: Memory, study: Study, known: UserBelief, number: int, attempt: int
) -> tuple[Decision, dict[str, Any]]:
    stored = read_decisions(memory, study, known.history.key, number)
    decision = next((one for one in stored if (one.number, one.attempt) == (number, attempt)), None)
    if decision is None:
        raise NotFoundError("the decision of this request was forgotten; give the request another identifier")
    return decision, _answer(study, known, decision, WorkingBelief(study, known.state.head))


def _answer(study: Study, known: UserBelief, decision: Decision, now: WorkingBelief) -> dict[str, Any]:
    by_features = study.feature_prior is not None and set(known.features or ()) == set(study.feature_prior.names)
    return {
        "user": known.history.user,
        "policy": decision.policy,
        "decision": known.history.identifier(decision),
        "number": decision.number,
        "probability": decision.probability,
        "available": None if decision.available is None else list(decision.available),
        "control": decision.control,
        "context": known.context if known.context in study.contexts and not by_features else None,
        "features": known.features if by_features else None,
        "belief": dict(zip(study.library.types, now.belief.tolist(), strict=True)),
        "expected": dict(zip(study.active, now.expected[study.active_numbers].tolist(), strict=True)),
        "surprise": known.state.head.surprise,
    }


def checked_features(study: Study, features: Mapping[str, float]) -> dict[str, float]:
    """The features of a user as the study knows them; errors as for `choose`."""
    if study.feature_prior is None:
        raise InputError(f"features must be left out: study '{study.name}' was fitted without --features")
    return study.feature_prior.checked(features)


def policy_odds(study: Study, now: WorkingBelief, available: Sequence[str] | None = None) -> Odds:
    """Policies in use, and the probability that the rule chooses each, with the share of exploration mixed in.

    Parameters
    ----------
    now : WorkingBelief
    available : sequence of str, optional
        The policies that the user can get now; all by default.

    Raises
    ------
    InputError
        No policy in use is available.
    """
    policies = [policy for policy in study.active if available is None or policy in available]
    if not policies:
        raise InputError(
            f"available must name a policy in use, got {', '.join(available or ())}, which the control group "
            f"alone gets; in use are {', '.join(study.active)}"
        )
    mask = available_mask(policies, study.library.policies)
    return Odds(policies, study.explored(now.propensities(mask)[mask]))


def _control_odds(study: Study, available: Sequence[str] | None) -> Odds:
    """The incumbent, or every policy in use alike, pilots too."""
    policies = [study.incumbent] if study.incumbent is not None else [*study.active, *study.pilots]
    if available is not None:
        every = [*study.active, *study.pilots]
        policies = [one for one in policies if one in available] or [one for one in every if one in available]
    return Odds(policies, np.full(len(policies), 1 / len(policies)))


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
    known = open_belief(memory, study, key, number=number)
    found = known.find(memory, study, number, attempt)
    if found is None:
        raise NotFoundError(f"no decision {decision} in study '{study.name}': never made here, or forgotten")
    _check_outcome(study, found.decision, outcome)
    after, taken = found.state_after(study, known.state, outcome), False
    if found.decision.outcome is None:
        record = known.history.outcome_record(found.decision, outcome, int(time.time()))
        taken = memory.contribute(
            known.history.robot, [record], process=_process(found.decision), seq=1,
            task={"study": study.name, "outcome": outcome},
            state=KeyState(known.name, known.token, after.to_bytes()),
        )  # fmt: skip
    if not taken:
        # The outcome was there before, or another process was faster.
        known = open_belief(memory, study, key, number=number)
        again, after = known.find(memory, study, number, attempt), known.state
        if again is None or again.decision.outcome != outcome:
            there = f"ended with {again.decision.outcome:g} already" if again else "was forgotten"
            raise InputError(f"decision {decision} {there}, got {outcome:g}; nothing changed")
    return {
        "decision": decision,
        "user": known.history.user,
        "policy": found.decision.policy,
        "outcome": outcome,
        "taken": taken,
        "belief": dict(zip(study.library.types, after.head.belief.tolist(), strict=True)),
    }


def _check_outcome(study: Study, decision: Decision, outcome: float) -> None:
    if not abs(outcome) <= LARGEST:
        raise InputError(f"outcome must be a finite number of at most {LARGEST:g} in size, got {outcome}")
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
    """Forget a user's past, decisions, outcomes and belief for good; the number of contributions removed.

    The library still follows from the user's lines in the log: remove them and fit again.

    Raises
    ------
    NotFoundError
        Nothing is known of the user.
    """
    key = user_key(study.name, user)
    decided = bool(open_history(memory, study, key).decisions)
    in_past = forget_past(memory, study.name, key)
    if not (decided or in_past):
        raise NotFoundError(f"nothing is stored of user '{user}' in study '{study.name}'")
    return memory.forget(robot_of(study.name, key)) if decided else 0
