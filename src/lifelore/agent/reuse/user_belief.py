"""The belief about one user, as memory stores it or as a replay of the evidence computes it.

Memory stores the evidence (`history`) and beside it the belief that follows (`user_state`). The stored belief
holds for one library, one prior, one past (`past`) and one set of cells. Where any of them is another, the
belief is computed again from the evidence, with the same bits: after a new fit, after a merge of memories, and
for histories of an earlier Lifelore.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.history import KIND, VERSION, Decision, History, decisions_in, read_decisions, slots_from
from lifelore.agent.reuse.past import PastUser, index_name, read_index, read_past_user
from lifelore.agent.reuse.study import Study
from lifelore.agent.reuse.user_state import Checkpoint, UserState, WorkingBelief, from_bytes
from lifelore.memory import Memory

NAMED_TYPE = 0.99
"""Belief in the type that a log names for a user; at 1, no outcome could correct a wrong name."""


@dataclass(frozen=True, eq=False)
class UserBelief:
    """What is known of a user before the next decision.

    history : without its decisions
    context : whose prior counts, or None
    features : numbers known of the user beforehand, or None
    token : of the cells in memory that the belief follows; None where there are none
    state : the belief
    late : the decisions from the number on that `open_belief` was asked for
    """

    history: History
    context: str | None
    features: dict[str, float] | None
    token: int | None
    state: UserState
    late: tuple[Decision, ...] = ()

    @property
    def name(self) -> tuple[str, str, int]:
        """Kind, key and version of the user's record."""
        return KIND, f"{self.history.study}/{self.history.key}", VERSION

    def find(self, memory: Memory, study: Study, number: int, attempt: int) -> "Found | None":
        """A decision as memory has it; None where there is none. `late` must begin with its number."""
        found = [one for one in self.late if (one.number, one.attempt) == (number, attempt)]
        if not found:
            return None
        start, decisions = self.state.before(number), self.late
        if start is not None and start.number < number:
            decisions = read_decisions(memory, study, self.history.key, start.number)
            found = [one for one in decisions if (one.number, one.attempt) == (number, attempt)]
        return Found(found[0], start, decisions) if found else None


class Found(NamedTuple):
    """A decision, and all that its outcome may change.

    decision : Decision
    start : the last checkpoint before it; None where its outcome is known and no belief depends on it any more
    decisions : all decisions from `start` on
    """

    decision: Decision
    start: Checkpoint | None
    decisions: tuple[Decision, ...]

    def state_after(self, study: Study, state: UserState, outcome: float) -> UserState:
        """The state with this outcome of the decision, if it has none yet."""
        if self.decision.outcome is not None or self.start is None:
            return state
        ended = [replace(one, outcome=outcome) if one is self.decision else one for one in self.decisions]
        return state.after(study, ended, self.start)


def open_belief(
    memory: Memory,
    study: Study,
    key: str,
    user: str = "",
    context: str | None = None,
    features: dict[str, float] | None = None,
    number: int | None = None,
) -> UserBelief:
    """The belief about a user, by a single statement where the stored state still holds.

    Parameters
    ----------
    user : str
        Name of the user; that in memory counts where memory knows the user.
    context : str, optional
        Context of the user; by default the one in memory.
    features : dict of str to float, optional
        Numbers known of the user beforehand; by default those in memory.
    number : int, optional
        Read the decisions from this number on too.
    """
    names = [(KIND, f"{study.name}/{key}", VERSION), index_name(study.name)]
    slots = None if number is None else slots_from(number)
    stored, past_index = memory.recall_states(names, slots=slots)
    about: Mapping[str, Any] = stored.about if stored else {"user": user}
    context, features = context or about.get("context"), features or about.get("features")
    history = History(study.name, key, about["user"], context, (), features)
    state = from_bytes(stored.content) if stored else None
    index = past_index.about if past_index else {}
    origin = {"study": study.fingerprint, "past": index.get("token"), "context": context}
    if features:
        origin["features"] = features
    if state is None or state.origin != origin:
        past = read_past_user(memory, study.name, index, key)
        context, features = context or past.context, features or past.features
        basis = basis_of(study, context, past, features)
        if state is None or state.basis != basis:
            decisions = read_decisions(memory, study, key) if stored else ()
            state = replayed(study, context, past, decisions, features)
        state = replace(state, origin=origin, context=context, features=features)
    late = decisions_in(memory, study, key, stored.record) if stored else ()
    return UserBelief(history, state.context, state.features, stored.token if stored else None, state, late)


def replayed(
    study: Study,
    context: str | None,
    past: PastUser,
    decisions: tuple[Decision, ...],
    features: dict[str, float] | None = None,
) -> UserState:
    """The state after the past and all decisions, from the prior on."""
    start = after_past(study, context, past, features).checkpoint(0)
    state = UserState(basis_of(study, context, past, features), {}, context, 0, (start,), features)
    return state.after(study, decisions, start)


def belief_anew(memory: Memory, study: Study, known: UserBelief, novelty: bool = False) -> WorkingBelief:
    """The belief about a user, with its evidence, by a replay of the past and all decisions.

    Parameters
    ----------
    novelty : bool
        As for `WorkingBelief.of_stranger`, errors too.
    """
    key = known.history.key
    past = read_past_user(memory, study.name, read_index(memory, study.name), key)
    belief = after_past(study, known.context, past, known.features, novelty)
    for decision in read_decisions(memory, study, key):
        belief.learn(decision.policy, decision.outcome)
    return belief


def after_past(
    study: Study, context: str | None, past: PastUser, features: dict[str, float] | None, novelty: bool = False
) -> WorkingBelief:
    """The belief after the past, from the prior on."""
    belief = WorkingBelief.of_stranger(study, prior_of(study, context, past, features), novelty)
    for policy, outcome in past.outcomes:
        belief.learn(policy, outcome)
    return belief


def expected_outcomes(study: Study, history: History, past: PastUser) -> NDArray[np.float64]:
    """Expected outcome of each policy of the library after all decisions of a history, (n_policies,)."""
    features = history.features or past.features
    head = replayed(study, history.context or past.context, past, history.decisions, features).head
    return WorkingBelief(study, head).expected


def prior_of(
    study: Study, context: str | None, past: PastUser, features: dict[str, float] | None = None
) -> NDArray[np.float64]:
    """Prior over types before the past, (n_types,): `Study.prior_of`, with `NAMED_TYPE` on a type a log names."""
    prior = study.prior_of(context, features)
    if past.type not in study.library.types:
        return prior
    named = np.zeros(len(prior))
    named[study.library.types.index(past.type)] = NAMED_TYPE
    return named + (1 - NAMED_TYPE) * prior


def basis_of(study: Study, context: str | None, past: PastUser, features: dict[str, float] | None = None) -> str:
    """Hash of all that a belief follows from, beside the decisions."""
    prior = prior_of(study, context, past, features)
    text = study.fingerprint + json.dumps(past.outcomes)
    return hashlib.sha256(text.encode() + prior.tobytes()).hexdigest()[:32]
