"""Signal tables in float32 with a row for each type, so that a product serves all policies at once.

A product in float32 takes half the time of a product in float64, and a single large product less than a small one
for each policy. Tables of exact models are left out: their types fall into few classes, which is faster still.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.selection.derived_arrays import DerivedArrays
from lifelore.interaction.selection.type_classes import type_classes

Singles = NDArray[np.float32]

LEAST_NUMBERS, MOST_NUMBERS = 1 << 15, 1 << 24
"""Sizes of tables that are copied: smaller tables gain nothing, larger copies take more than 64 MiB."""
ROUNDING = 2.0**-24
"""Largest relative error of rounding a number to float32."""
NEGLIGIBLE = 1e-25
"""Shares of a belief below this are 0 in float32: their products with a table's entries would be subnormal."""


class SignalRows(NamedTuple):
    """P(signal | type, policy) in float32, types first.

    values : (n_types, n_policies * n_signals) float32, entries 0 or at least 1e-9
    n_policies, n_signals : int
    """

    values: Singles
    n_policies: int
    n_signals: int


def signal_rows(table: SignalTable) -> SignalRows | None:
    """The rows of a table, computed once for each table; None where its size or its classes speak against them."""
    if not LEAST_NUMBERS <= table.probs.size <= MOST_NUMBERS or type_classes(table).few:
        return None
    return SignalRows(_values(table), table.n_policies, table.n_signals)


def _empty(table: SignalTable) -> Singles:
    return np.empty((table.n_types, table.n_policies * table.n_signals), np.float32)


def _fill(values: Singles, table: SignalTable, policies: Iterable[int]) -> None:
    by_policy = values.reshape(table.n_types, table.n_policies, table.n_signals)
    for policy in policies:
        by_policy[:, policy] = table.probs[policy]


_values = DerivedArrays(_empty, _fill)
