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


@pytest.mark.parametrize("entropy_first", [False, True])
def test_a_part_is_the_table_of_these_users_and_policies(entropy_first):
    probs = np.random.default_rng(0).dirichlet(np.ones(3), (4, 2, 5))
    rows, policies = np.array([2, 0]), np.array([True, False, True, True, False])
    users, shared = SignalTable(probs), SignalTable(probs[0])
    if entropy_first:
        assert users.conditional_entropy.size + shared.conditional_entropy.size == 50
    for part, expected in (
        (users.part(rows, policies), probs[rows][:, :, policies]),
        (users.part(slice(None), policies), probs[:, :, policies]),
        (shared.part(rows, policies), probs[0][:, policies]),
    ):
        np.testing.assert_allclose(part.probs, expected)
        np.testing.assert_allclose(part.conditional_entropy, SignalTable(expected).conditional_entropy)


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
