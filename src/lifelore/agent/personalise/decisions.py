"""Decisions for users of a study and their outcomes: `decide` and `observe`, for one user or many.

    decide    belief of each user → probabilities of policies → a policy drawn, stored with its probability
    observe   outcome of a decision, stored once → the user's belief learns → stored with it

Each is one transaction: after a crash at any moment a decision or an outcome is there as a whole or not at all.
Users are locked while their beliefs change, so that several programs may serve a study.
"""

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import repeat, starmap
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.beliefs import Beliefs, learn, open_beliefs, probabilities, stored_beliefs
from lifelore.agent.personalise.identifiers import identifier, identifiers, new_ids, parse_identifier
from lifelore.agent.personalise.registration import checked_available
from lifelore.agent.personalise.study import Study, known_users, shares_of
from lifelore.core.errors import InputError, LifeloreError, NotFoundError
from lifelore.interaction.outcomes.outcome_rows import LARGEST
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name
from lifelore.memory.refusal import RacedError
from lifelore.memory.study_rows import DecisionRow, StudyRows, UserRow

Answer = dict[str, Any]
ATTEMPTS = 3
"""Number of times that a decision is tried again where another program is faster."""


class Request(NamedTuple):
    """A user who needs a policy now.

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
        not available, the control group gets each available policy with equal probability.
    request : str, optional
        Identifier of the request, unique for the user. The same request again gets the decision that it got
        before, and nothing is stored.

    Examples
    --------
    >>> Request("ann", context="phone", available=["calm", "jazz"]).user
    'ann'
    """

    user: str
    context: str | None = None
    features: Mapping[str, float] | None = None
    available: Sequence[str] | None = None
    request: str | None = None


def choose(
    memory: Memory, study: Study, user: str, *, seed: int = 0, novelty: bool = False, **known: Any
) -> Answer:
    """Choose a policy for a user's next visit, and store the decision.

    Parameters
    ----------
    user : str
    seed : int
        The draw depends on the seed, the study, the user and the number of the user's decisions alone.
    novelty : bool
        Whether to compute the probability that no type of the library fits the user. The time grows with the
        number of the user's outcomes.
    **known
        Fields of `Request`: context, features, available, request.

    Returns
    -------
    dict
        ``user``, ``policy``, ``decision`` (to give the outcome by), ``probability`` of the policy at this moment,
        ``control``; ``available`` policies (None: all); ``features`` whose prior counts, else ``context`` whose
        prior counts (both None: everybody's); ``belief`` by type; ``expected`` outcome and ``probabilities`` by
        active policy; ``repeated``: whether the request was answered before; ``novelty``: the probability that no
        type of the library fits the user, as far as it was asked for, else None.

    Raises
    ------
    InputError
        A name that is no printable text, no available policy is in use, a feature is missing, the study is
        archived, or the request was made before with other available policies.
    NotFoundError
        There is no such policy or feature.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore import PolicyLibrary, open_memory
    >>> from lifelore.agent.personalise.registration import register
    >>> library = PolicyLibrary.from_means([[8.0, 2.0], [3.0, 9.0]], 1.0, policies=["calm", "jazz"])
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/songs.db") as memory:
    ...     study = register(memory, "songs", library)
    ...     made = choose(memory, study, "ann")
    >>> sorted(made)[:3]
    ['available', 'belief', 'context']
    """
    (answer,) = decide(memory, study, [Request(user, **known)], seed=seed)
    if isinstance(answer, LifeloreError):
        raise answer
    from lifelore.agent.personalise.explanation import novelty_of

    return answer | {"novelty": novelty_of(memory, study, user) if novelty else None}


def decide(
    memory: Memory, study: Study, requests: Sequence[Request], *, seed: int = 0, brief: bool = False
) -> list[Answer | LifeloreError]:
    """Choose a policy for each of several users, in one transaction.

    A user who comes twice gets two decisions by the same belief.

    Parameters
    ----------
    seed : int
        As for `choose`.
    brief : bool
        Leave out what only describes the belief, as for very many users.

    Returns
    -------
    list
        For each request the document of `choose`, or the error of this request alone.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore import PolicyLibrary, open_memory
    >>> from lifelore.agent.personalise.registration import register
    >>> library = PolicyLibrary.from_means([[8.0, 2.0], [3.0, 9.0]], 1.0, policies=["calm", "jazz"])
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/songs.db") as memory:
    ...     study = register(memory, "songs", library)
    ...     made = decide(memory, study, [Request("ann"), Request("ben", available=["jazz"])])
    >>> made[1]["policy"]
    'jazz'
    """
    if study.archived:
        raise InputError(f"study '{study.name}' is archived; make it active again first")
    return _again_if_raced(_decided, memory, study, requests, seed, brief)


def _again_if_raced(function: Callable[..., Any], *arguments: Any) -> Any:
    """The result of a transaction, which another program may have come before with the same request or users."""
    for _ in range(ATTEMPTS):
        with suppress(RacedError):
            return function(*arguments)
    return function(*arguments)


def _decided(
    memory: Memory, study: Study, requests: Sequence[Request], seed: int, brief: bool
) -> list[Answer | LifeloreError]:
    answers: list[Any] = [_or_error(_checked, request, study) for request in requests]
    good = [place for place, one in enumerate(answers) if not isinstance(one, LifeloreError)]
    if not good:
        return answers
    checked: list[Request] = [answers[place] for place in good]
    with memory.studies.writing(study.number) as rows:
        users = _users(memory, rows, study, checked)
        own = [users[request.user] for request in checked]
        keys = {at: (own[at].number, one.request) for at, one in enumerate(checked) if one.request is not None}
        made = rows.requested(list(keys.values())) if keys else {}
        beliefs = open_beliefs(rows, study, list(users.values()))
        if beliefs.replayed:
            rows.keep_beliefs(stored_beliefs(beliefs, beliefs.replayed), study.version)
        row = np.array([beliefs.row[user.number] for user in own], np.int64)
        probs = probabilities(study, beliefs.algorithm, row, _may(study, checked))
        first = {key: at for at, key in reversed(keys.items())}
        new = [at for at in range(len(own)) if at not in keys or (keys[at] not in made and first[keys[at]] == at)]
        drawn = _drawn(study, [own[at] for at in new], [checked[at] for at in new], probs[new], seed)
        rows.add_decisions(drawn)
    for at, decision, text in zip(new, drawn, identifiers([one.id for one in drawn]), strict=True):
        answers[good[at]] = _answer(decision, text, repeated=False)
        if at in keys:
            made[keys[at]] = decision
    for at in keys.keys() - set(new):
        answers[good[at]] = _or_error(_repeated, checked[at], made[keys[at]])
    if not brief:
        described = _described(study, own, checked, beliefs.algorithm, row, probs)
        for place, about in zip(good, described, strict=True):
            if isinstance(answers[place], dict):
                answers[place] |= about
    return answers


def _checked(request: Request, study: Study) -> Request:
    """The request with checked names; `InputError` or `NotFoundError` where one breaks its rule."""
    check_name("user", request.user)
    if request.context is not None:
        check_name("context", request.context)
    if request.request is not None:
        check_name("request", request.request)
    features, available = request.features, request.available
    if features is None and available is None:
        return request
    if features is not None:
        if study.feature_prior is None:
            raise InputError(f"features must be left out: study '{study.name}' was fitted without --features")
        features = study.feature_prior.checked(features)
    if available is not None:
        available = checked_available(study, available)
        if not set(available) & set(study.active) and not study.holds_out(request.user):
            raise InputError(
                f"available must name a policy in use, got {', '.join(available)}, which the control group "
                f"alone gets; in use are {', '.join(study.active)}"
            )
    return Request(request.user, request.context, features, available, request.request)


def _users(memory: Memory, rows: StudyRows, study: Study, requests: Sequence[Request]) -> dict[str, UserRow]:
    """The users of requests by name; adds new users, and stores the contexts and features of requests."""
    names = list({request.user: None for request in requests})
    users = known_users(rows, study, names, lock=True, count=True)
    given = {request.user: request for request in requests if request.context or request.features}
    if len(users) < len(names):
        new = [name for name in names if name not in users]
        strangers = [given.get(name, Request(name)) for name in new]
        users |= rows.add_users([(one.user, one.context, one.features) for one in strangers], study.version)
        if len(users) < len(names):
            raise RacedError(f"memory {memory.location}: a user was forgotten at this moment; try again")
    touched = [users[name].number for name in _changed(given, users)]
    touched += [user.number for user in users.values() if user.version != study.version]
    if touched:  # their beliefs will be computed again, so nobody may add to the evidence in the meantime
        for user in rows.numbered(touched, lock=True).values():
            users[user.name] = user._replace(n_decisions=users[user.name].n_decisions)
    if changed := _changed(given, users):
        rows.describe((user.number, user.context, user.features, user.type) for user in changed.values())
    return users | changed


def _changed(given: Mapping[str, Request], users: Mapping[str, UserRow]) -> dict[str, UserRow]:
    """The users whose requests give another context or other features than are stored, with the new ones."""
    found = {}
    for name, request in given.items():
        user = users[name]
        now = user._replace(
            context=request.context or user.context, features=dict(request.features or user.features or {}) or None
        )
        if now != user:
            found[name] = now._replace(version=0)
    return found


def _may(study: Study, requests: Sequence[Request]) -> NDArray[np.bool_]:
    """Which policies in use each user can get, (n, n_active); all where it is none, as in the control group."""
    may = np.ones((len(requests), len(study.active)), bool)
    for row, request in enumerate(requests):
        if request.available is not None:
            may[row] = [policy in request.available for policy in study.active]
    may[~may.any(axis=1)] = True
    return may


def _drawn(
    study: Study, users: Sequence[UserRow], requests: Sequence[Request], probs: NDArray[np.float64], seed: int
) -> list[DecisionRow]:
    """A new decision for each user: the policy that a number in [0, 1) falls on, none of probability 0."""
    names, numbers = [user.name for user in users], [user.n_decisions for user in users]
    if len(set(names)) < len(names):  # somebody comes more than once
        counted = Counter[str]()
        for place, name in enumerate(names):
            numbers[place] += counted[name]
            counted[name] += 1
    draws, held_out = shares_of((seed, study.name), names, numbers), study.held_out(names)
    ends = probs.cumsum(axis=1)
    last = probs.shape[1] - 1 - (probs[:, ::-1] > 0).argmax(axis=1)
    chosen = np.minimum((ends <= draws[:, None] * ends[:, -1:]).sum(axis=1), last)
    probability = probs[np.arange(len(chosen)), chosen].tolist()
    policies = [study.active[place] for place in chosen.tolist()]
    for row in np.flatnonzero(held_out).tolist():
        among = _for_control(study, requests[row].available)
        policies[row], probability[row] = among[int(draws[row] * len(among))], 1 / len(among)
    now = time.time_ns() // 10**6
    columns = zip(
        new_ids(now, len(users)), [user.number for user in users], policies, probability, held_out.tolist(),
        repeat(study.version), repeat(now), [user.context for user in users],
        [None if one.available is None else tuple(one.available) for one in requests],
        [request.request for request in requests], repeat(None), repeat(None), numbers,
    )  # fmt: skip
    return list(starmap(DecisionRow, columns))


def _for_control(study: Study, available: Sequence[str] | None) -> list[str]:
    """What the control group gets, each alike: the incumbent, or every policy in use, pilots too."""
    every = [*study.active, *study.pilots]
    policies = [study.incumbent] if study.incumbent is not None else every
    if available is None:
        return policies
    return [one for one in policies if one in available] or [one for one in every if one in available]


def _described(
    study: Study,
    users: Sequence[UserRow],
    requests: Sequence[Request],
    algorithm: ReuseAlgorithm,
    rows: NDArray[np.int64],
    probs: NDArray[np.float64],
) -> list[Answer]:
    """What answers say of the users and of the beliefs before the decisions."""
    belief = algorithm.belief(rows)
    expected = algorithm.known(rows).performance.expected(belief)[:, study.active_numbers]
    learnt = set() if study.feature_prior is None else set(study.feature_prior.names)
    found = []
    for user, request, *numbers in zip(
        users, requests, belief.tolist(), expected.tolist(), probs.tolist(), strict=True
    ):
        by_features = bool(learnt) and set(user.features or ()) == learnt
        found.append({
            "available": None if request.available is None else list(request.available),
            "user": user.name,
            "context": user.context if user.context in study.contexts and not by_features else None,
            "features": user.features if by_features else None,
            "belief": dict(zip(study.library.types, numbers[0], strict=True)),
            "expected": dict(zip(study.active, numbers[1], strict=True)),
            "probabilities": dict(zip(study.active, numbers[2], strict=True)),
        })  # fmt: skip
    return found


def _repeated(request: Request, decision: DecisionRow) -> Answer:
    available = None if request.available is None else tuple(request.available)
    if available != decision.available:
        raise InputError(
            f"request '{request.request}' of this user was made with other available policies; give this one "
            "another identifier"
        )
    return _answer(decision, identifier(decision.id), repeated=True)


def _answer(decision: DecisionRow, text: str, *, repeated: bool) -> Answer:
    return {
        "decision": text,
        "policy": decision.policy,
        "probability": decision.probability,
        "control": decision.control,
        "repeated": repeated,
    }


def update(memory: Memory, study: Study, decision: str, outcome: float) -> Answer:
    """Store the outcome of a decision, once, at any later time.

    Returns
    -------
    dict
        ``decision``, ``user``, ``policy``, ``control``, ``outcome``; ``taken``: False where the same outcome
        was there already and nothing changed; ``belief`` by type after it.

    Raises
    ------
    NotFoundError
        No such decision: never made here, or forgotten.
    InputError
        The outcome is no finite number, none of the values a categorical library knows, or another one was taken.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore import PolicyLibrary, open_memory
    >>> from lifelore.agent.personalise.registration import register
    >>> library = PolicyLibrary.from_means([[8.0, 2.0], [3.0, 9.0]], 1.0, policies=["calm", "jazz"])
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/songs.db") as memory:
    ...     study = register(memory, "songs", library)
    ...     made = choose(memory, study, "ann")
    ...     update(memory, study, made["decision"], 8.0)["taken"]
    True
    """
    (answer,) = observe(memory, study, [(decision, outcome)])
    if isinstance(answer, LifeloreError):
        raise answer
    return answer


def observe(
    memory: Memory, study: Study, outcomes: Sequence[tuple[str, float]], *, brief: bool = False
) -> list[Answer | LifeloreError]:
    """Store the outcomes of decisions, each once, in one transaction; beliefs learn in the order of the decisions.

    Parameters
    ----------
    outcomes : sequence of (identifier of a decision, outcome)
    brief : bool
        As for `decide`.

    Returns
    -------
    list
        For each outcome the document of `update`, or its error.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore import PolicyLibrary, open_memory
    >>> from lifelore.agent.personalise.registration import register
    >>> library = PolicyLibrary.from_means([[8.0, 2.0], [3.0, 9.0]], 1.0, policies=["calm", "jazz"])
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/songs.db") as memory:
    ...     study = register(memory, "songs", library)
    ...     made = decide(memory, study, [Request("ann")])
    ...     observe(memory, study, [(made[0]["decision"], 8.0)])[0]["taken"]
    True
    """
    return _again_if_raced(_observed, memory, study, outcomes, brief)


def _observed(
    memory: Memory, study: Study, outcomes: Sequence[tuple[str, float]], brief: bool
) -> list[Answer | LifeloreError]:
    answers: list[Any] = [_or_error(_checked_outcome, *pair) for pair in outcomes]
    good = [place for place, one in enumerate(answers) if isinstance(one, tuple)]
    if not good:
        return answers
    with memory.studies.writing(study.number) as rows:
        ids = list({answers[place][0]: None for place in good})
        found, users = rows.locked_decisions(ids)
        beliefs = open_beliefs(rows, study, list(users.values()))
        taken: dict[bytes, float] = {}
        for place in good:
            id_, outcome = answers[place]
            answers[place] = _or_error(_taken, study, found.get(id_), taken, id_, outcome)
        # Outcomes of one moment count in the order of their decisions, in a replay too.
        taken = dict(sorted(taken.items()))
        now = time.time_ns() // 10**6
        rows.end_decisions((id_, outcome, now) for id_, outcome in taken.items())
        evidence = [(beliefs.row[found[id_].person], found[id_].policy, outcome) for id_, outcome in taken.items()]
        learn(beliefs.algorithm, study, evidence)
        rows.learn(_learnt(beliefs, found, taken), study.version)
    ended = [place for place in good if isinstance(answers[place], tuple)]
    if brief:
        for place in ended:
            decision, _, new = answers[place]
            answers[place] = {"taken": new, "policy": decision.policy, "control": decision.control}
        return answers
    row = np.array([beliefs.row[answers[place][0].person] for place in ended], np.int64)
    for place, belief in zip(ended, beliefs.algorithm.belief(row).tolist(), strict=True):
        decision, outcome, new = answers[place]
        answers[place] = {
            "decision": identifier(decision.id),
            "user": users[decision.person].name,
            "policy": decision.policy,
            "control": decision.control,
            "outcome": outcome,
            "taken": new,
            "belief": dict(zip(study.library.types, belief, strict=True)),
        }
    return answers


def _checked_outcome(decision: str, outcome: Any) -> tuple[bytes, float]:
    if (
        isinstance(outcome, bool)
        or not isinstance(outcome, int | float | np.number)
        or not abs(outcome) <= LARGEST
    ):
        raise InputError(f"outcome must be a finite number of at most {LARGEST:g} in size, got {outcome!r:.60}")
    return parse_identifier(decision), float(outcome)


def _taken(
    study: Study, decision: DecisionRow | None, taken: dict[bytes, float], id_: bytes, outcome: float
) -> tuple[DecisionRow, float, bool]:
    """The decision, its outcome and whether it is new; new ones are added to `taken`."""
    if decision is None:
        raise NotFoundError(
            f"no decision {identifier(id_)} in study '{study.name}': never made here, or forgotten"
        )
    before = taken.get(id_, decision.outcome)
    if before is not None and before != outcome:
        raise InputError(
            f"decision {identifier(id_)} ended with {before:g} already, got {outcome:g}; nothing changed"
        )
    if before is None:
        _check_value(study, decision.policy, outcome)
        taken[id_] = outcome
    return decision, outcome, before is None


def _check_value(study: Study, policy: str, outcome: float) -> None:
    """Raise InputError for an outcome that no type can have."""
    performance: Any = study.library.performance
    if policy not in study.library.policies or performance.kind != "categorical":
        return
    column = study.library.index_of_policy(policy)
    if np.isneginf(performance.log_density(column, outcome)).all():
        values = ", ".join(f"{value:g}" for value in performance.values)
        raise InputError(f"outcome must be one of {values}, got {outcome:g}; fit again from a log that has it")


def _learnt(
    beliefs: Beliefs, found: Mapping[bytes, DecisionRow], taken: Mapping[bytes, float]
) -> list[tuple[int, bytes, int, float, int, float]]:
    """What memory adds to each user: the belief, and numbers and sums of outcomes by group."""
    sums: dict[int, list[Any]] = {number: [0, 0.0, 0, 0.0] for number in beliefs.replayed}
    for id_, outcome in taken.items():
        own, place = sums.setdefault(found[id_].person, [0, 0.0, 0, 0.0]), 2 * found[id_].control
        own[place] += 1
        own[place + 1] += outcome
    return [(number, state, *sums[number]) for number, state in stored_beliefs(beliefs, sums)]  # pyright: ignore


def forget(memory: Memory, study: Study, user: str) -> int:
    """Forget a user's past, decisions, outcomes and belief for ever; the number of rows removed.

    The library still follows from the user's lines in the log: remove them and fit again.

    Raises
    ------
    NotFoundError
        Nothing is known of the user.
    """
    with memory.studies.writing(study.number) as rows:
        known = known_users(rows, study, [user]).get(user)
        count = None if known is None else rows.forget(known.number)
        if count is None:
            raise NotFoundError(f"nothing is stored of user '{user}' in study '{study.name}'")
    memory.studies.forgotten()
    return count


def _or_error(function: Any, *arguments: Any) -> Any:
    try:
        return function(*arguments)
    except LifeloreError as error:
        return error
