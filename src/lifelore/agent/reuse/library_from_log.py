"""A policy library from the rows of a log whose users' types are known, found or guessed."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.log import ReuseLog
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.outcome_model import OutcomeRows
from lifelore.interaction.outcomes.spread import spread_between

FEW_VALUES = 10
"""Outcomes of at most so many different values are categories, not amounts, unless the settings name a model."""


class TypedRows(NamedTuple):
    """Rows of a log with the type of each row's user.

    rows : (n,) int64 places in the log
    types : (n,) int64, places in `names`
    names : of the types
    guessed : how many rows' types were guessed from outcomes
    found : whether the types themselves were found
    criteria : of each number of types tried
    """

    rows: NDArray[np.int64]
    types: NDArray[np.int64]
    names: tuple[str, ...]
    guessed: int = 0
    found: bool = False
    criteria: tuple[float, ...] = ()

    def users(self, log: ReuseLog) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Users of the rows, as places in ``log.user.names``, and the type of each."""
        users, first = np.unique(log.user.codes[self.rows], return_index=True)
        return users, self.types[first]


def library_of(log: ReuseLog, typed: TypedRows, model: str) -> tuple[PolicyLibrary, NDArray[np.float64]]:
    """The library, and the number of outcomes of each pair, (n_types, n_policies)."""
    policies, of_policy = np.unique(log.policy.codes[typed.rows], return_inverse=True)
    rows = OutcomeRows(typed.types, of_policy, log.outcomes[typed.rows], (len(typed.names), len(policies)))
    prior = np.ones(len(typed.names)) + np.bincount(typed.users(log)[1], minlength=len(typed.names))
    names = [log.policy.names[code] for code in policies]
    library = PolicyLibrary.from_rows(
        _lent(rows), typed.names, names, model_of(log, model), prior=prior / prior.sum()
    )
    # Users are the tasks: those of one type may differ.
    spread = spread_between(rows.pair, log.user.codes[typed.rows], rows.values)
    if spread is not None:
        library.performance.spread = spread  # pyright: ignore[reportAttributeAccessIssue]
    return library, rows.sums()


def model_of(log: ReuseLog, model: str) -> str:
    """The outcomes' model, chosen by their values where it is ``auto``."""
    if model != "auto":
        return model
    return "categorical" if len(np.unique(log.outcomes)) <= FEW_VALUES else "gaussian"


def _lent(rows: OutcomeRows) -> OutcomeRows:
    """The rows, and for each pair without one the policy's rows on all types: expected is what everybody gets."""
    parts = [rows]
    for type_, policy in np.argwhere(rows.sums() == 0):
        values = rows.values[rows.policies == policy]
        parts.append(OutcomeRows(np.full(len(values), type_), np.full(len(values), policy), values, rows.shape))
    types, policies, values = (np.concatenate(column) for column in list(zip(*parts, strict=True))[:3])
    return OutcomeRows(types, policies, values, rows.shape)
