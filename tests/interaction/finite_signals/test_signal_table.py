"""Tables of signals: what they refuse, clean, and know of their entropy."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable


def test_entropy_by_hand():
    table = SignalTable([[[0.5, 0.25, 0.25]], [[1.0, 0.0, 0.0]]])
    np.testing.assert_allclose(table.conditional_entropy, [[1.5 * np.log(2)], [0.0]])
    assert (table.n_types, table.n_policies, table.n_signals) == (2, 1, 3)
    users = SignalTable([table.probs, table.probs[::-1]])
    np.testing.assert_allclose(users.conditional_entropy[1], [[0.0], [1.5 * np.log(2)]])
    assert (users.n_types, users.n_policies, users.n_signals) == (2, 1, 3)


def test_what_is_too_small_becomes_zero_and_rows_sum_to_one():
    table = SignalTable([[[1 - 3e-10, 3e-10], [0.5, 0.5]]])
    assert table.probs[0, 0].tolist() == [1.0, 0.0]


@pytest.mark.parametrize(
    "probs",
    [[[[0.5, 0.6]]], [[[1.5, -0.5]]], [[[np.nan, 1.0]]], [[0.5, 0.5]], np.empty((0, 1, 1)), [[[np.inf, 0.0]]]],
)
def test_what_is_no_distribution_is_refused(probs):
    with pytest.raises(InputError, match="probs must be"):
        SignalTable(probs)


def test_the_pair_whose_row_is_no_distribution_is_named():
    probs = np.full((2, 3, 2), 0.5)
    probs[1, 2] = [0.5, 0.75]
    with pytest.raises(InputError, match=r"type 1 with policy 2 has a row of sum 1\.25"):
        SignalTable(probs)
