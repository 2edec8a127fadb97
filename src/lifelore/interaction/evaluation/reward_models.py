"""Reward models of doubly robust estimates: expected outcomes, learnt without the users whom they predict."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.evaluation.estimate_by_user import user_codes

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

FOLDS = 5
"""Parts of the users; a model is learnt on all parts but one. More parts cost time and learn from more users."""


def user_folds(users: ArrayLike, generator: np.random.Generator) -> Numbers:
    """A random part of the users for each row, (n,) int64 from 0; parts differ by at most one user.

    All rows of a user are in the same part. There are as many parts as users where those are fewer.

    Raises
    ------
    InputError
        There are fewer than two users.
    """
    codes = user_codes(users)
    n_users = int(codes.max(initial=-1)) + 1
    if n_users < 2:
        raise InputError(f"cross-fitting needs at least 2 users, got {n_users}")
    return (generator.permutation(n_users) % min(FOLDS, n_users))[codes]


@dataclass(frozen=True, eq=False)
class RewardModel:
    """Expected outcome of every policy before each decision.

    Parameters
    ----------
    table : (k, n_policies) float64
        Finite.
    row : (n,) int64
        The row of the table for each decision; decisions may share a row.
    """

    table: Array
    row: Numbers

    def of_policies(self, policies: Numbers | int) -> Array:
        """Expected outcome of a policy for each decision, (n,)."""
        return self.table[self.row, policies]

    def of_choices(self, probabilities: Array) -> Array:
        """Expected outcome of a choice with `probabilities` (n, n_policies), (n,)."""
        return (probabilities * self.table[self.row]).sum(axis=1)


def policy_means(outcomes: Array, policies: Numbers, n_policies: int, folds: Numbers) -> RewardModel:
    """Mean outcome of each policy outside each decision's part of the users.

    A policy without an outcome there gets the mean of all outcomes there.

    Parameters
    ----------
    outcomes : (n,) float64
    policies : (n,) int64
        In 0 … n_policies − 1.
    folds : (n,) int64
        See `user_folds`.

    Examples
    --------
    >>> import numpy as np
    >>> model = policy_means(np.array([8.0, 2.0, 6.0, 4.0]), np.array([0, 1, 0, 1]), 2, np.array([0, 0, 1, 1]))
    >>> model.table.tolist()
    [[6.0, 4.0], [8.0, 2.0]]
    """
    n_folds = int(folds.max()) + 1
    cell = folds * n_policies + policies
    counts = np.bincount(cell, minlength=n_folds * n_policies).reshape(n_folds, n_policies)
    sums = np.bincount(cell, outcomes, minlength=n_folds * n_policies).reshape(n_folds, n_policies)
    counts, sums = counts.sum(axis=0) - counts, sums.sum(axis=0) - sums
    overall = sums.sum(axis=1, keepdims=True) / counts.sum(axis=1, keepdims=True)
    return RewardModel(np.where(counts > 0, sums / np.maximum(counts, 1), overall), folds)
