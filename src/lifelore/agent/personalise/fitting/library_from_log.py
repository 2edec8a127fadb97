"""Who is of which type, as a log names it or by outcomes, and the policy library of rows with types."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.user_types import user_types
from lifelore.interaction.outcomes.joint_normal_fit import joint_normal_fit
from lifelore.interaction.outcomes.joint_normal_outcomes import JointNormalOutcomes
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows
from lifelore.interaction.outcomes.spread import spread_between

FITTED_NUMBERS = 4_000_000
"""Largest number of users times squared policies that a covariance is fitted to, else to a sample of users."""


class TypedRows(NamedTuple):
    """Rows of a log with the type of each row's user.

    rows : (n,) int64 places in the log
    types : (n,) int64, places in `names`
    names : of the types
    found : whether the types themselves were found
    contexts : how many contexts have types of their own, numbered context by context; 0: types are everybody's
    """

    rows: NDArray[np.int64]
    types: NDArray[np.int64]
    names: tuple[str, ...]
    found: bool = False
    contexts: int = 0

    def users(self, log: ReuseLog) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Users of the rows, as places in ``log.user.names``, and the type of each."""
        users, first = np.unique(log.user.codes[self.rows], return_index=True)
        return users, self.types[first]


class Fitted(NamedTuple):
    """A library learnt from a log.

    library : PolicyLibrary
    typed : the rows that its types are of
    counts : (n_types, n_policies) float64, number of outcomes of each pair
    """

    library: PolicyLibrary
    typed: TypedRows
    counts: NDArray[np.float64]


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
    n_users = len(log.user.names)
    if n_types > n_users:
        raise InputError(f"types must be at most {n_users}, the users of the log, got {n_types}")
    rows = OutcomeRows(log.user.codes, log.policy.codes, log.outcomes, (n_users, len(log.policy.names)))
    family = "categorical" if model == "categorical" else "gaussian"
    found = user_types(rows, generator, n_types, family=family)
    names = tuple(f"type {number + 1}" for number in range(found.n_types))
    every: NDArray[np.int64] = np.arange(len(log))
    return TypedRows(every, found.labels[log.user.codes], names, True)


def library_of(log: ReuseLog, typed: TypedRows, model: str) -> Fitted:
    """The library of typed rows.

    Rows of weight 0 are left out. Weights count in the outcomes of each pair, not in the prior over types.

    Raises
    ------
    InputError
        All weights are 0.
    """
    used = np.ones(len(typed.rows), bool) if log.weights is None else log.weights[typed.rows] > 0
    if not used.any():
        raise InputError("weight must be above 0 on at least one line, got 0 on all")
    places = typed.rows[used]
    policies, of_policy = np.unique(log.policy.codes[places], return_inverse=True)
    rows = OutcomeRows(typed.types[used], of_policy, log.outcomes[places], (len(typed.names), len(policies)))
    lent, weights = _lent(rows, np.ones(len(places)) if log.weights is None else log.weights[places])
    prior = np.ones(len(typed.names)) + np.bincount(typed.users(log)[1], minlength=len(typed.names))
    names = [log.policy.names[code] for code in policies]
    if model == JointNormalOutcomes.kind:
        return Fitted(_joint_normal(log, typed, places, of_policy, names), typed, rows.sums())
    library = PolicyLibrary.from_rows(
        lent, typed.names, names, model, prior=prior / prior.sum(),
        weights=None if log.weights is None else weights,
    )  # fmt: skip
    # Users are the tasks: those of one type may differ.
    spread = spread_between(rows.pair, log.user.codes[places], rows.values)
    if spread is not None:
        library.performance.spread = spread  # pyright: ignore[reportAttributeAccessIssue]
    return Fitted(library, typed, rows.sums())


def _joint_normal(
    log: ReuseLog, typed: TypedRows, places: NDArray[np.int64], of_policy: NDArray[np.int64], names: list[str]
) -> PolicyLibrary:
    """The library of users whose outcomes are jointly normal, fitted from the users' types on."""
    if log.weights is not None:
        raise InputError("model must be gaussian, student-t or categorical where lines have weights")
    users, of_user = np.unique(log.user.codes[places], return_inverse=True)
    most = min(len(users), max(1, FITTED_NUMBERS // len(names) ** 2))
    some = np.isin(of_user, np.linspace(0, len(users) - 1, most).astype(np.int64))
    # Every policy needs a row.
    some |= np.isin(np.arange(len(places)), np.unique(of_policy, return_index=True)[1])
    fitted, of_fitted = np.unique(of_user[some], return_inverse=True)
    rows = OutcomeRows(of_fitted, of_policy[some], log.outcomes[places][some], (len(fitted), len(names)))
    types = dict(zip(*typed.users(log), strict=True))
    near = np.eye(len(typed.names))[[types[user] for user in users[fitted].tolist()]]
    found = joint_normal_fit(rows, 0.9 * near + 0.1 / len(typed.names))
    prior = 1 + len(users) * found.weights
    return PolicyLibrary(found.model, None, typed.names, tuple(names), prior / prior.sum())  # pyright: ignore


def _lent(rows: OutcomeRows, weights: NDArray[np.float64]) -> tuple[OutcomeRows, NDArray[np.float64]]:
    """The rows, and for each pair without one the policy's rows on all types: expected is what everybody gets."""
    parts = [(rows.types, rows.policies, rows.values, weights)]
    for type_, policy in np.argwhere(rows.sums() == 0):
        own = rows.policies == policy
        n = int(own.sum())
        parts.append((np.full(n, type_), np.full(n, policy), rows.values[own], weights[own]))
    types, policies, values, weights = (np.concatenate(column) for column in zip(*parts, strict=True))
    return OutcomeRows(types, policies, values, rows.shape), weights
