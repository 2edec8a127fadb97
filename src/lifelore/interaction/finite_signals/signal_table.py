"""Table of P(signal | type, policy) for signals from a finite alphabet, and their conditional entropies.

The rules that look ahead (belief entropy, knowledge gradient, information-directed) sum over signals and need
no other model of them. Thesis: §4.4.1, Def. 4.4.2.
"""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy

Array = NDArray[np.float64]

LEAST = 1e-9
"""Probabilities below this become 0: they change no choice, and subnormal products take 9 to 24 times as long."""


class SignalTable:
    """P(signal | type, policy) over a finite alphabet, the same for all users or with a leading axis of users.

    Parameters
    ----------
    probs : (n_types, n_policies, n_signals) or (k, n_types, n_policies, n_signals) float
        At least 0; each row over signals sums to 1 to 1e-6.

    Attributes
    ----------
    probs : float64 of the same shape
        A copy. Entries below 1e-9 are 0, rows sum to 1.

    Raises
    ------
    InputError
        The shape differs, or a row is no distribution.

    Examples
    --------
    >>> table = SignalTable([[[0.5, 0.5]], [[1.0, 0.0]]])
    >>> table.conditional_entropy.round(4).tolist()
    [[0.6931], [0.0]]
    """

    def __init__(self, probs: ArrayLike) -> None:
        given = np.asarray(probs, np.float64)
        if given.ndim not in (3, 4) or not given.size:
            shape = "([k users,] n_types, n_policies, n_signals)"
            raise InputError(f"probs must be {shape} numbers, none of them 0, got {given.shape}")
        sums = given.sum(axis=-1)
        near = np.abs(sums - 1) <= 1e-6 * max(1.0, given.shape[-1] ** 0.5)
        if not (near.all() and given.min() >= 0):
            pair = np.argwhere(~near | (given < 0).any(axis=-1))[0]
            raise InputError(
                f"probs must be at least 0 and each row over signals sum to 1, type {pair[-2]} with policy "
                f"{pair[-1]} has a row of sum {sums[tuple(pair)]:.9g}"
            )
        self.probs: Array = np.where(given < LEAST, 0.0, given)
        self.probs /= self.probs.sum(axis=-1, keepdims=True)

    @property
    def n_types(self) -> int:
        return self.probs.shape[-3]

    @property
    def n_policies(self) -> int:
        return self.probs.shape[-2]

    @property
    def n_signals(self) -> int:
        return self.probs.shape[-1]

    @cached_property
    def conditional_entropy(self) -> Array:
        """H(signal | type, policy) in nats, (n_types, n_policies) or (k, n_types, n_policies); computed once."""
        return entropy(self.probs)

    def part(self, rows: Any, policies: Any) -> "SignalTable":
        """The table of some users and policies.

        Parameters
        ----------
        rows : slice or (m,) int64
            Numbers of users; a table that all users share has no such axis and ignores them.
        policies : (n_policies,) bool or (n,) int64
        """
        table = object.__new__(SignalTable)
        own = self.probs.ndim == 4
        table.probs = (self.probs[rows] if own else self.probs)[..., policies, :]
        if "conditional_entropy" in self.__dict__:
            known = self.conditional_entropy
            table.conditional_entropy = (known[rows] if own else known)[..., policies]
        return table

    def replaced(self, shape: tuple[int, ...], at: tuple[Any, Any], probs: Array) -> "SignalTable":
        """The table of users (shape, at most one axis) who share this one but for some pairs.

        Parameters
        ----------
        at : (m,) int64 twice
            Rows of users, 0 for a single user, and policies.
        probs : (m, n_types, n_signals) float64
            Rows sum to 1.
        """
        table, (rows, policies) = object.__new__(SignalTable), at
        n = shape[0] if shape else 1
        whole = np.repeat(self.probs[None], n, axis=0)
        known = np.repeat(self.conditional_entropy[None], n, axis=0)
        whole[rows, :, policies], known[rows, :, policies] = probs, entropy(probs)
        table.probs = whole.reshape(*shape, *self.probs.shape)
        table.conditional_entropy = known.reshape(*shape, *self.conditional_entropy.shape)
        return table
