"""Types that a policy cannot tell apart: for that policy they count as one, exactly.

A drone over one place sees poachers there, next to it, two away, or not at all: five laws of signals for 68
types. Sums over types then have as many terms as there are laws. Models learnt from samples have no two laws
alike, and nothing is gained.
"""

from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.interaction.finite_signals.signal_table import SignalTable


class TypeClasses(NamedTuple):
    """Which types share a law of signals.

    of_type : (n_policies, n_types) int32, equal numbers for equal laws of one policy, from 0
    number : (n_policies,) int64, how many laws each policy has
    few : bool, whether policies have at most half as many laws as there are types, on average
    """

    of_type: NDArray[np.int32]
    number: NDArray[np.int64]
    few: bool


_KNOWN: WeakKeyDictionary[SignalTable, TypeClasses] = WeakKeyDictionary()


def type_classes(table: SignalTable) -> TypeClasses:
    """The classes of a table's types, found once for each table."""
    found = _KNOWN.get(table)
    if found is None:
        found = _KNOWN[table] = _classes(table)
    return found


def _classes(table: SignalTable) -> TypeClasses:
    mark = stream(0, "type classes").random(table.n_signals).astype(table.probs.dtype)
    of_type = np.empty(table.probs.shape[:2], np.int32)
    for policy, laws in enumerate(table.probs):
        of_type[policy] = _equal_rows(laws, mark)
    number = of_type.max(axis=1).astype(np.int64) + 1
    return TypeClasses(of_type, number, bool(2 * number.mean() <= table.n_types))


def _equal_rows(rows: NDArray, mark: NDArray) -> NDArray[np.int64]:
    """Numbers from 0 for rows (n, k), equal for equal rows."""
    # Equal rows have equal sums, and sums are soon compared; that unequal rows have unequal sums is checked.
    _, first, number = np.unique((rows * mark).sum(axis=1), return_index=True, return_inverse=True)
    if len(first) < len(rows) and not np.array_equal(rows, rows[first[number]]):
        number = np.unique(rows, axis=0, return_inverse=True)[1]
    return number.ravel()
