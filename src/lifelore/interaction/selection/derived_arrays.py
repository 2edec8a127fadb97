"""Arrays computed from a signal table, once for each table; parts are renewed where its rows were replaced."""

from collections.abc import Callable, Iterable
from typing import Any
from weakref import WeakKeyDictionary

from numpy.typing import NDArray

from lifelore.interaction.finite_signals.signal_table import SignalTable

Fill = Callable[[NDArray[Any], SignalTable, Iterable[int]], None]


class DerivedArrays:
    """A function from signal tables to arrays, computed once for each table.

    Parameters
    ----------
    empty : callable
        The array of a table, not filled.
    fill : callable
        ``fill(array, table, policies)`` writes the parts of some policies.
    """

    def __init__(self, empty: Callable[[SignalTable], NDArray[Any]], fill: Fill) -> None:
        self._empty, self._fill = empty, fill
        self._known: WeakKeyDictionary[SignalTable, tuple[NDArray[Any], int]] = WeakKeyDictionary()

    def __call__(self, table: SignalTable) -> NDArray[Any]:
        """The array as the table is now."""
        array, seen = self._known.get(table, (None, 0))
        if array is None:
            array = self._empty(table)
            self._fill(array, table, range(table.n_policies))
        elif seen < len(table.replaced):
            self._fill(array, table, set(table.replaced[seen:]))
        else:
            return array
        self._known[table] = array, len(table.replaced)
        return array
