"""Who is of which type: as a log names it, or by types found among the users."""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.fitting.library_from_log import TypedRows
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.core.errors import InputError
from lifelore.interaction.library.user_types import user_types
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows


def typed_rows(log: ReuseLog, model: str, n_types: int | None, generator: np.random.Generator) -> TypedRows:
    """The rows whose user's type is named or found.

    Raises
    ------
    InputError
        There are more types than users.
    """
    if not log.says_types:
        return _found(log, model, n_types or 1, generator)
    return _named(log)


def _named(log: ReuseLog) -> TypedRows:
    """Rows that name a type, and those of users whose type other rows name."""
    types = log.type_of_user[log.user.codes]
    rows = np.flatnonzero(types >= 0)
    codes, own = np.unique(types[rows], return_inverse=True)
    return TypedRows(rows, own, tuple(log.type.names[code] for code in codes))


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
    return TypedRows(every, found.labels[of_user], names, True)
