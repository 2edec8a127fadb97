"""Table of P(signal | type, policy) for signals from a finite alphabet, and their conditional entropies.

The rules that look ahead (belief entropy, knowledge gradient, information-directed) sum over signals and need
no other model of them. Thesis: §4.4.1, Def. 4.4.2.
"""

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

LEAST = 1e-9
"""Probabilities below this become 0: they change no choice, and subnormal products take 9 to 24 times as long."""


class SignalTable:
    """P(signal | type, policy) over a finite alphabet.

    Parameters
    ----------
    probs : (n_policies, n_types, n_signals) float
        At least 0; each row over signals sums to 1 to 1e-6. Policy first, so that one policy's rows lie together.
        float32 stays float32; all else becomes float64.
    copy : bool
        False cleans the caller's own array in place, which saves memory.

    Attributes
    ----------
    probs : (n_policies, n_types, n_signals) float
        Entries below 1e-9 are 0, rows sum to 1.
    conditional_entropy : (n_policies, n_types) float
        H(signal | type, policy) in nats.
    replaced : list of int
        Policies in the order in which their rows were replaced. Arrays computed from the table follow it.

    Raises
    ------
    InputError
        The shape differs, or a row is no distribution.

    Examples
    --------
    >>> table = SignalTable([[[0.5, 0.5], [1.0, 0.0]]])
    >>> table.conditional_entropy.round(4).tolist()
    [[0.6931, 0.0]]
    """

    def __init__(self, probs: ArrayLike, copy: bool = True) -> None:
        probs = np.asarray(probs)
        kind = np.float32 if probs.dtype == np.float32 else np.float64
        self.probs: NDArray[Any] = np.array(probs, kind, order="C", copy=copy or None)
        if self.probs.ndim != 3 or not self.probs.size:
            raise InputError(
                f"probs must be (n_policies, n_types, n_signals) numbers, none of them 0, got {self.probs.shape}"
            )
        self.conditional_entropy: NDArray[Any] = np.empty(self.probs.shape[:2], kind)
        self.replaced: list[int] = []
        # One policy at a time: a thousand types and policies leave no room for temporaries of the table's size.
        for policy, rows in enumerate(self.probs):
            _clean(rows, policy)
            self.conditional_entropy[policy] = 0 - _times_log(rows).sum(axis=1)

    @classmethod
    def restored(cls, probs: NDArray[Any]) -> Self:
        """The table that `probs` were read from, bit for bit; they are not copied.

        Raises
        ------
        InputError
            As for the constructor.
        """
        table = cls(probs)
        # Dividing rows by their sums once more may move the last bit.
        if not np.allclose(table.probs, probs, rtol=0, atol=LEAST):
            raise InputError("probs must be those of a table, got rows that do not sum to 1")
        table.probs = probs
        for policy, rows in enumerate(probs):
            table.conditional_entropy[policy] = 0 - _times_log(rows).sum(axis=1)
        return table

    def copy(self) -> Self:
        """A table of its own with the same numbers."""
        table = type(self).__new__(type(self))
        table.probs, table.conditional_entropy = self.probs.copy(), self.conditional_entropy.copy()
        table.replaced = []
        return table

    def replace(self, policy: int, rows: NDArray[Any]) -> None:
        """Put other rows (n_types, n_signals) in place of a policy's; types that were alike must stay so."""
        self.probs[policy] = rows
        _clean(self.probs[policy], policy)
        self.conditional_entropy[policy] = 0 - _times_log(self.probs[policy]).sum(axis=1)
        self.replaced.append(policy)

    def replace_many(self, policies: list[int], rows: NDArray[Any]) -> None:
        """`replace` of several policies at once, by rows (n, n_types, n_signals), which are cleaned in place."""
        flat = rows.reshape(-1, rows.shape[-1])
        _clean(flat, f"{policies[0]} to {policies[-1]}")
        self.probs[policies] = rows
        # In the precision of the table, as for a single policy.
        if rows.dtype != self.probs.dtype:
            flat = self.probs[policies].reshape(flat.shape)
        self.conditional_entropy[policies] = 0 - _times_log(flat).sum(axis=1).reshape(rows.shape[:2])
        self.replaced.extend(policies)

    @property
    def n_policies(self) -> int:
        return self.probs.shape[0]

    @property
    def n_types(self) -> int:
        return self.probs.shape[1]

    @property
    def n_signals(self) -> int:
        return self.probs.shape[2]


def _clean(rows: NDArray[Any], policy: int | str) -> None:
    """Raise InputError where a row is no distribution; set small entries to 0 and renormalise, in place."""
    sums = rows.sum(axis=1, keepdims=True)
    if not ((rows >= 0).all() and (np.abs(sums - 1) <= 1e-6 * max(1.0, rows.shape[1] ** 0.5)).all()):
        raise InputError(f"probs must be at least 0 and each row over signals sum to 1, policy {policy}'s do not")
    rows[rows < LEAST] = 0
    rows /= rows.sum(axis=1, keepdims=True)


def _times_log(rows: NDArray[Any]) -> NDArray[Any]:
    return rows * np.log(np.where(rows > 0, rows, 1))
