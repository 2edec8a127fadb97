"""`Words`: the relations outside the core vocabulary that a model can state, such as *left_of*."""

from collections.abc import Iterable
from dataclasses import dataclass

from lifelore.core.relations import CORE_RELATIONS


@dataclass(frozen=True)
class Words:
    """Relations of a user.

    Parameters
    ----------
    names : tuple of str
        Sorted, none of the core vocabulary.
    symmetric : frozenset of str
        Those that hold for (b, a) when they hold for (a, b).

    Examples
    --------
    >>> Words.outside_core(["on", "under", "near"], ["adjacent", "near"])
    Words(names=('near', 'under'), symmetric=frozenset({'near'}))
    """

    names: tuple[str, ...] = ()
    symmetric: frozenset[str] = frozenset()

    @classmethod
    def outside_core(cls, names: Iterable[str], symmetric: Iterable[str]) -> "Words":
        """The words among `names`, and which of them are among `symmetric`."""
        words = tuple(sorted(set(names) - set(CORE_RELATIONS)))
        return cls(words, frozenset(symmetric) & frozenset(words))


NO_WORDS = Words()
