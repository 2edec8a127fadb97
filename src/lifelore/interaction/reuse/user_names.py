"""Names of users: which row of the beliefs belongs to which name."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError

Numbers = NDArray[np.int64]


class UserNames:
    """Distinct names, numbered in the order in which they were added.

    Parameters
    ----------
    names : iterable of str

    Raises
    ------
    InputError
        A name is no text, or comes twice.
    """

    def __init__(self, names: Iterable[str] = ()) -> None:
        self._row: dict[str, int] = {}
        self.add(names)

    def __len__(self) -> int:
        return len(self._row)

    def __iter__(self):
        return iter(self._row)

    def add(self, names: Iterable[str]) -> Numbers:
        """The rows of new names, (k,); nothing is added where a name is known already."""
        new = [names] if isinstance(names, str) else list(names)
        for name in new:
            if not isinstance(name, str):
                raise InputError(f"names of users must be texts, got {name!r:.80}")
        if len(set(new)) < len(new) or not self._row.keys().isdisjoint(new):
            twice = next(name for name in new if name in self._row or new.count(name) > 1)
            raise InputError(f"names of users must be distinct, {twice!r} is there already")
        first = len(self._row)
        self._row.update(zip(new, range(first, first + len(new)), strict=True))
        return np.arange(first, first + len(new))

    def unknown(self, names: Sequence[str]) -> list[str]:
        """The names that have no row, each once, in their order."""
        return list(dict.fromkeys(name for name in names if name not in self._row))

    def rows(self, names: Sequence[str]) -> Numbers:
        """The rows of known names, (k,); NotFoundError where there is no such name."""
        try:
            return np.array([self._row[name] for name in names], np.int64)
        except KeyError as error:
            raise NotFoundError(
                f"unknown user {error}; there are {len(self)}; add_users adds it, or unknown='add' at first use"
            ) from None


def are_names(users: ArrayLike | Sequence[Any]) -> bool:
    """Whether users are given by names: a text, or a sequence that begins with a text."""
    if isinstance(users, str):
        return True
    if isinstance(users, np.ndarray):
        return users.dtype.kind in "UO" and users.size > 0 and isinstance(users.ravel()[0], str)
    return isinstance(users, Sequence) and len(users) > 0 and isinstance(users[0], str)
