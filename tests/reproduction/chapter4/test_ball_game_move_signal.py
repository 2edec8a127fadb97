"""Likelihoods of moves from counts, by hand, and what is refused."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from reproduction.chapter4.ball_game.move_signal import MoveSignal

COUNTS = np.array([[[2.0], [6.0], [0.0], [0.0]]])
"""One policy and type, two contexts of two outcomes."""


def test_counts_and_two_prior_moves_by_hand():
    # Two prior moves shared out over two outcomes: (2 + 1) / 10 and (6 + 1) / 10; without counts a half each.
    signal = MoveSignal.from_counts(COUNTS, 2)
    assert np.exp(signal.log_table).ravel().tolist() == pytest.approx([0.3, 0.7, 0.5, 0.5])
    assert np.exp(signal.log_likelihood(0, 1)).tolist() == pytest.approx([0.7])


def test_the_law_of_many_moves_is_that_of_each():
    signal = MoveSignal(np.log(np.random.default_rng(0).dirichlet(np.ones(6), (3, 4)).transpose(0, 2, 1)))
    law, policies, moves = signal.law(), np.array([0, 2, 2, 1]), np.array([5, 0, 3, 3])
    each = [signal.log_likelihood(int(p), int(m)) for p, m in zip(policies, moves, strict=True)]
    found = law.log_likelihoods(policies, law.checked(moves))
    assert found.reshape(4, 4).tolist() == [own.tolist() for own in each]


def test_bad_input():
    for table in (np.zeros((2, 3)), np.full((1, 2, 3), np.nan), np.full((1, 2, 3), np.inf), np.zeros((1, 0, 3))):
        with pytest.raises(InputError, match="log_table must be"):
            MoveSignal(table)
    signal = MoveSignal.from_counts(COUNTS, 2)
    for bad in (4, -1, 0.5):
        with pytest.raises(InputError, match="a move must be a whole number from 0 to 3"):
            signal.log_likelihood(0, bad)  # pyright: ignore[reportArgumentType]
    with pytest.raises(InputError, match="a move must be"):
        signal.law().checked(np.array([0, 4]))
    with pytest.raises(NotFoundError):
        signal.log_likelihood(1, 0)
