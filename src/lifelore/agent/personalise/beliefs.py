"""Beliefs about users of a study as rows of Algorithm 7: from stored bytes, or by a replay of the evidence.

A stored belief holds for one version of the study. After a new version, where a user's context, features or named
type have changed, and where an earlier Lifelore stored it in another form, it follows from the evidence again: the
outcomes of the past, then those of decisions in the order in which they came. An outcome that comes late is thus
learnt when it comes.
"""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.study import Study
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.reuse.user_beliefs import blocks
from lifelore.memory.study_rows import StudyRows, UserRow

Numbers = NDArray[np.int64]


class Beliefs(NamedTuple):
    """Rows of some users.

    algorithm : a row a user
    row : the row of each user, by the user's number
    replayed : numbers of the users whose stored belief did not hold any more
    """

    algorithm: ReuseAlgorithm
    row: dict[int, int]
    replayed: list[int]


def open_beliefs(rows: StudyRows, study: Study, users: Sequence[UserRow]) -> Beliefs:
    """The beliefs about users."""
    algorithm = study.algorithm.new_rows(len(users))
    start_at_priors(algorithm, study, users)
    # Beliefs of another width are of another Lifelore.
    width = 8 * algorithm.width
    current = [
        user.version == study.version and (user.state is None or len(user.state) == width) for user in users
    ]
    stored = [place for place, user in enumerate(users) if current[place] and user.state is not None]
    if stored:
        packed = np.frombuffer(b"".join(users[place].state or b"" for place in stored), "<f8")
        algorithm.unpack(np.array(stored), packed.reshape(len(stored), -1))
    stale = [place for place, holds in enumerate(current) if not holds]
    row = {user.number: place for place, user in enumerate(users)}
    if stale:
        evidence = rows.evidence([users[place].number for place in stale])
        learn(algorithm, study, [(row[number], policy, outcome) for number, policy, outcome in evidence])
    return Beliefs(algorithm, row, [users[place].number for place in stale])


def start_at_priors(algorithm: ReuseAlgorithm, study: Study, users: Sequence[UserRow]) -> None:
    """Set the belief about each user to the user's prior."""
    known: dict[tuple[str | None, str | None], NDArray[np.float64]] = {}
    for place, user in enumerate(users):
        if user.features:
            algorithm.log_belief[place] = algorithm.start(study.prior_of(user.context, user.features, user.type))
        elif user.context or user.type:
            key = user.context, user.type
            if key not in known:
                known[key] = algorithm.start(study.prior_of(user.context, None, user.type))
            algorithm.log_belief[place] = known[key]


def learn(algorithm: ReuseAlgorithm, study: Study, evidence: Iterable[tuple[int, str, float]]) -> None:
    """Learn from (row, policy, outcome) in their order; an outcome is also the end of an episode."""
    for rows, policies, outcomes in turns(study, evidence):
        learn_turn(algorithm, rows, policies, outcomes)


def learn_turn(algorithm: ReuseAlgorithm, rows: Numbers, policies: Numbers, outcomes: NDArray[np.float64]) -> None:
    """Learn from an outcome of each of distinct rows.

    A policy that the library does not know (−1) gives no evidence, but the user's type may change all the same.
    """
    known = policies >= 0
    if known.any():
        algorithm.observe(rows[known], policies[known], outcomes[known])
    algorithm.end_episode(rows)


def turns(
    study: Study, evidence: Iterable[tuple[int, str, float]]
) -> Iterable[tuple[Numbers, Numbers, NDArray[np.float64]]]:
    """Rows, policies and outcomes of each user's first outcome, of each user's second one, and so on."""
    number_of = {policy: number for number, policy in enumerate(study.library.policies)}
    rounds: list[list[tuple[int, int, float]]] = []
    seen: dict[int, int] = {}
    for row, policy, outcome in evidence:
        turn = seen.get(row, 0)
        seen[row] = turn + 1
        if turn == len(rounds):
            rounds.append([])
        rounds[turn].append((row, number_of.get(policy, -1), outcome))
    for taken in rounds:
        rows, policies, outcomes = zip(*taken, strict=True)
        yield np.array(rows), np.array(policies), np.array(outcomes, np.float64)


def stored_beliefs(beliefs: Beliefs, numbers: Iterable[int]) -> list[tuple[int, bytes]]:
    """What memory stores of users: number and belief."""
    listed = list(numbers)
    if not listed:
        return []
    packed = beliefs.algorithm.packed(np.array([beliefs.row[number] for number in listed])).astype("<f8")
    return [(number, row.tobytes()) for number, row in zip(listed, packed, strict=True)]


def probabilities(
    study: Study, algorithm: ReuseAlgorithm, rows: Numbers, may: NDArray[np.bool_] | None = None
) -> NDArray[np.float64]:
    """Probabilities of the policies in use, (n, n_active), with the share of exploration mixed in; rows sum to 1.

    Parameters
    ----------
    rows : (n,) int64
        Of the algorithm.
    may : (n, n_active) bool, optional
        Which policies each user can get, at least one; by default all.
    """
    active, library = study.active_numbers, study.library
    may = np.ones((len(rows), len(active)), bool) if may is None else may
    mask = np.zeros((len(rows), library.n_policies), bool)
    mask[:, active] = may
    probs = np.empty(may.shape)
    for part in blocks(len(rows), algorithm, study.selection):
        probs[part] = algorithm.propensities(rows[part], study.selection, mask[part])[:, active]
    probs = (1 - study.explore) * probs + study.explore * may / may.sum(axis=1, keepdims=True)
    return probs / probs.sum(axis=1, keepdims=True)


def unknown_probability(
    study: Study, users: Sequence[UserRow], evidence: Iterable[tuple[int, str, float]]
) -> NDArray[np.float64]:
    """The probability that no known type fits, of each user; InputError where no broad law is known."""
    from lifelore.interaction.reuse.novelty.unknown_evidence import unknown_evidence

    models: Any = study.models
    found = unknown_evidence(study.library, len(users), dynamics=study.dynamics, models=models)
    start_at_priors(found, study, users)
    row = {user.number: place for place, user in enumerate(users)}
    own = [(row[number], policy, outcome) for number, policy, outcome in evidence]
    learn(found, study, own)
    return found.unknown.probability(slice(None))
