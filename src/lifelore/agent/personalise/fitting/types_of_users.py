"""Who is of which type: as a log names it, as outcomes suggest, or by types found among the users."""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.fitting.library_from_log import TypedRows, library_of
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.evaluation.propensity_weights import decision_numbers
from lifelore.interaction.library.user_types import user_types
from lifelore.interaction.outcomes.outcome_model import OutcomeRows
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm

CERTAIN = 0.9
"""Belief from which a user's type, which the log does not name, is taken to be known."""


def typed_rows(log: ReuseLog, model: str, n_types: int | None, generator: np.random.Generator) -> TypedRows:
    """The rows whose user's type is named, suggested by outcomes, or found.

    Raises
    ------
    InputError
        There are more types than users.
    """
    if not log.says_types:
        return _found(log, model, n_types or 1, generator)
    return _with_guessed(log, _named(log), model)


def _named(log: ReuseLog) -> TypedRows:
    """Rows that name a type, and those of users whose type other rows name."""
    types = log.type_of_user[log.user.codes]
    rows = np.flatnonzero(types >= 0)
    codes, own = np.unique(types[rows], return_inverse=True)
    return TypedRows(rows, own, tuple(log.type.names[code] for code in codes))


def _with_guessed(log: ReuseLog, named: TypedRows, model: str) -> TypedRows:
    """Also the rows of users of whom nobody says the type, and whose outcomes leave little doubt of it."""
    waiting = np.flatnonzero(log.type_of_user[log.user.codes] < 0)
    if not waiting.size:
        return named
    library = library_of(log, named, model).library
    place = {policy: number for number, policy in enumerate(library.policies)}
    policies = np.array([place.get(policy, -1) for policy in log.policy.names])[log.policy.codes[waiting]]
    users, user = np.unique(log.user.codes[waiting], return_inverse=True)
    turn, outcomes = decision_numbers(user), log.outcomes[waiting]
    algorithm = ReuseAlgorithm(library, len(users), dynamics=TypeDynamics.static(), models="plug-in")
    for number in range(turn.max() + 1):
        at = (turn == number) & (policies >= 0)
        if at.any():
            algorithm.update(user[at], policies[at], outcomes[at])
    belief = algorithm.belief(np.arange(len(users)))
    sure = (belief.max(axis=1) >= CERTAIN)[user]
    return named._replace(
        rows=np.concatenate([named.rows, waiting[sure]]),
        types=np.concatenate([named.types, belief.argmax(axis=1)[user][sure]]),
        guessed=int(sure.sum()),
    )


def _found(log: ReuseLog, model: str, n_types: int, generator: np.random.Generator) -> TypedRows:
    """Types found among users by their outcomes."""
    users, of_user = np.unique(log.user.codes, return_inverse=True)
    if n_types > len(users):
        raise InputError(f"types must be at most {len(users)}, the users of the log, got {n_types}")
    policies, of_policy = np.unique(log.policy.codes, return_inverse=True)
    rows = OutcomeRows(of_user, of_policy, log.outcomes, (len(users), len(policies)))
    family = "categorical" if model == "categorical" else "gaussian"
    found = user_types(rows, generator, n_types, family=family)
    names = tuple(f"type {number + 1}" for number in range(found.n_types))
    every: NDArray[np.int64] = np.arange(len(log))
    return TypedRows(every, found.labels[of_user], names, 0, True)
