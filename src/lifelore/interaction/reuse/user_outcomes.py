"""What very many users have shown: for each user and tried policy, the statistics of the outcomes.

A policy that a user never tried takes no memory, so a user takes 8 bytes and 144 for every five tried policies
(Gaussian outcomes) or eleven different outcomes (categories, histograms).
"""

from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.reuse.outcome_laws import Array, Numbers, OutcomeLaw, Shown, Tried

GROWTH = 16
"""The chunks' memory grows by one part in this many; more makes larger steps rarer and idle memory smaller."""


class UserOutcomes:
    """Statistics of the outcomes of `n_users` users.

    Parameters
    ----------
    law : OutcomeLaw
        Of the library that the outcomes are compared with.
    n_users : int

    Attributes
    ----------
    law : OutcomeLaw
        May be replaced by another of the same kind and size.
    """

    def __init__(self, law: OutcomeLaw, n_users: int) -> None:
        self.law = law
        self._heads, self._sizes = np.full(n_users, -1, np.int32), np.zeros(n_users, np.int32)
        self._state = np.array([0, -1, 0])
        self._real: Array = np.empty((0, _kernels().WORDS))

    @property
    def nbytes(self) -> int:
        """Memory in bytes."""
        return self._heads.nbytes + self._sizes.nbytes + self._real.nbytes

    def write(self, users: Numbers, policies: Numbers, signals: Any, out: Array) -> None:
        """Write log densities (k, n_types) of checked signals given what users have shown, and add the signals."""
        self._reserve(len(users))
        self.law.write(self._shown(), users, policies, signals, out)

    def tried(self, users: Numbers) -> Tried:
        """The policies that `users` tried."""
        return self.law.tried(self._shown(), users)

    def predict(self, users: Numbers, policies: Numbers, signals: Any, out: Array, new: Array) -> None:
        """Write log densities (k, n_types) of checked signals, into `new` those of users who showed nothing."""
        self.law.write(self._shown(), users, policies, signals, out, adds=False)
        self.law.write_new(policies, signals, new)

    def add(self, users: Numbers, policies: Numbers, signals: Any, keeps: Array) -> None:
        """Add checked signals of distinct users, after what they have shown counts `keeps` (k,) of what it did.

        Where `keeps` is NaN, nothing changes.
        """
        self._reserve(len(users))
        self.law.add(self._shown(), users, policies, signals, keeps)

    def slots(self, user: int) -> tuple[Numbers, Array]:
        """The keys (m,) and numbers (m, groups) of what a single user has shown; see `OutcomeLaw.task`."""
        n, groups = self.law.n_slots, self.law.groups
        keys, numbers = [np.empty(0, np.int64)], [np.empty((0, groups))]
        chunk, left = int(self._heads[user]), int(self._sizes[user])
        while chunk >= 0:
            here, row = (left - 1) % n + 1, self._real[chunk]
            whole = row.view(np.int32)
            keys.append(whole[2 * groups * n :][:here].astype(np.int64))
            numbers.append(row[: groups * n].reshape(groups, n)[:, :here].T)
            left, chunk = left - here, int(whole[_kernels().NEXT])
        return np.concatenate(keys), np.concatenate(numbers)

    def reset(self, users: Numbers) -> None:
        """Forget what distinct `users` have shown; their memory serves others."""
        _kernels().give_back(users, self._heads, self._sizes, self._shown().whole, self._state)

    def grow(self, n_users: int) -> None:
        """Make room for `n_users` users; new users have shown nothing."""
        more = n_users - len(self._heads)
        self._heads = np.concatenate([self._heads, np.full(more, -1, np.int32)])
        self._sizes = np.concatenate([self._sizes, np.zeros(more, np.int32)])

    def to_arrays(self, n_users: int) -> dict[str, NDArray[Any]]:
        """The state of the first `n_users` users, which `restore` takes."""
        used = int(self._state[0])
        return {
            "heads": self._heads[:n_users],
            "sizes": self._sizes[:n_users],
            "chunks": self._real[:used],
            "chunk_state": self._state,
        }

    def restore(self, arrays: dict[str, NDArray[Any]]) -> None:
        """Take over the state of `to_arrays`; ValueError where the arrays are no such state."""
        heads, sizes, chunks, state = (arrays[name] for name in ("heads", "sizes", "chunks", "chunk_state"))
        n, used = len(self._heads), len(chunks)
        good = heads.dtype == sizes.dtype == np.int32 and heads.shape == sizes.shape == (n,)
        good = good and chunks.dtype == np.float64 and chunks.shape == (used, _kernels().WORDS)
        if not (good and state.shape == (3,) and state[0] == used and -1 <= state[1] < used):
            raise ValueError("the statistics of users have other shapes")
        whole = np.ascontiguousarray(chunks).view(np.int32)
        following, n = whole[:, _kernels().NEXT], self.law.n_slots
        keys = whole[:, 2 * self.law.groups * n :][:, :n]
        named = np.concatenate([heads, following, state[1:2]])
        named = named[named >= 0]
        if not (named < used).all() or len(np.unique(named)) < len(named) or (keys >= self.law.n_keys).any():
            raise ValueError("the statistics of users name parts that do not exist")
        left, chunk = sizes.astype(np.int64), heads.copy()
        while (chunk >= 0).any():
            left[chunk >= 0] -= (left[chunk >= 0] - 1) % n + 1
            chunk[chunk >= 0] = following[chunk[chunk >= 0]]
        free, chunk = 0, int(state[1])
        while chunk >= 0:
            free, chunk = free + 1, int(following[chunk])
        if left.any() or free != state[2]:
            raise ValueError("the statistics of users have other lengths")
        self._heads, self._sizes, self._real = heads.copy(), sizes.copy(), chunks.copy()
        self._state = state.astype(np.int64)

    def _shown(self) -> Shown:
        return Shown(self._heads, self._sizes, self._real, self._real.view(np.int32), self._state)

    def _reserve(self, n: int) -> None:
        """Make room for `n` more chunks: an outcome takes at most one."""
        used, room = int(self._state[0]), len(self._real)
        n -= min(n, int(self._state[2]))
        if used + n > room:
            grown = np.zeros((used + n + room // GROWTH, self._real.shape[1]))
            grown[:used] = self._real[:used]
            self._real = grown


@cache
def _kernels() -> ModuleType:
    # Imported at the first use: the import starts Numba.
    from lifelore.interaction.reuse import user_outcome_kernels

    return user_outcome_kernels
