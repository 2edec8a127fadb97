"""Classes of types whose signal distributions are equal under a policy; sums over types then run over classes.

A drone over a place sees poachers there, next to it, at other distances, or not at all: five distributions of
signals for 68 types. Models learnt from samples have no two equal distributions, and classes save nothing.
"""

from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.interaction.finite_signals.signal_table import SignalTable


class TypeClasses(NamedTuple):
    """The types that share a distribution of signals, for each policy.

    of_type : (n_policies, n_types) int32, equal numbers for equal distributions under a policy, from 0
    number : (n_policies,) int64, number of distributions of each policy
    few : bool, whether policies have at most half as many distributions as there are types, on average
    """

    of_type: NDArray[np.int32]
    number: NDArray[np.int64]
    few: bool


_KNOWN: WeakKeyDictionary[SignalTable, TypeClasses] = WeakKeyDictionary()


def type_classes(table: SignalTable) -> TypeClasses:
    """The classes of a table's types, computed once for each table."""
    found = _KNOWN.get(table)
    if found is None:
        found = _KNOWN[table] = _classes(table)
    return found


def _classes(table: SignalTable) -> TypeClasses:
    # In float64, because sums of different rows are often equal in float32.
    mark = stream(0, "type classes").random(table.n_signals)
    of_type = np.empty(table.probs.shape[:2], np.int32)
    for policy, laws in enumerate(table.probs):
        of_type[policy] = _equal_rows(laws, mark)
    number = of_type.max(axis=1).astype(np.int64) + 1
    return TypeClasses(of_type, number, bool(2 * number.mean() <= table.n_types))


def _equal_rows(rows: NDArray, mark: NDArray) -> NDArray[np.int64]:
    """Numbers from 0 for rows (n, k), equal for equal rows."""
    # Equal rows have equal sums, and sums are compared faster than rows; the converse is checked.
    _, first, number = np.unique((rows * mark).sum(axis=1), return_index=True, return_inverse=True)
    if len(first) < len(rows) and not np.array_equal(rows, rows[first[number]]):
        number = np.unique(rows, axis=0, return_inverse=True)[1]
    return number.ravel()
