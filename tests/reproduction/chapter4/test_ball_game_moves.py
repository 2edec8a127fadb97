"""Signals of the ball game by hand and against a naive reading."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.domains.ball_game.ball_game import MOVES, ball_game
from reproduction.chapter4.ball_game.moves import (
    FATES,
    N_AFTER,
    N_BEFORE,
    N_CONTEXTS,
    N_OUTCOMES,
    N_SIGNALS,
    move_context,
    move_fate,
    move_outcome,
    move_signal,
    read_moves,
    room_along,
)

FIELD = ball_game().field
NORTH, SOUTH, EAST = 0, 1, 2


def test_fates_by_hand():
    def fate(x1, y1):
        return FATES[move_fate(100, 100, EAST, 30, x1, y1)]

    assert fate(130, 92) == "made"
    assert fate(70, 108) == "back"
    assert fate(96, 130) == fate(103, 70) == "aside"
    assert fate(100, 95) == fate(110, 100) == "not made"
    assert fate(116, 100) == "made"  # stopped, but more than half of the way


def test_a_signal_by_hand():
    # In mid corridor of 160: room of 80 on the spot; 50 south only 30 is left on the way's end.
    context = move_context(FIELD, 500, 80, SOUTH, 50)
    assert context == 6 * N_BEFORE + 4
    assert move_outcome(FIELD, 500, 80, SOUTH, 50, 500, 130) == 0 * N_AFTER + 7  # made; 30 in [30, 40)
    signal = np.empty(2, np.int64)
    before = np.array([[500, 80], [500, 80]])
    here = np.array([500, 500]), np.array([130, 130])
    read_moves(FIELD, before, np.array([SOUTH, -1]), np.array([2, 2]), *here, signal)
    assert signal.tolist() == [context * N_OUTCOMES + 7, -1]


@given(st.integers(1, 999), st.integers(1, 999), st.integers(0, 3), st.integers(30, 70))
@settings(deadline=None, max_examples=150)
def test_room_along_is_the_least_on_the_way(x, y, heading, distance):
    dx, dy = MOVES[heading].tolist()
    rooms = []
    for moved in range(distance + 1):
        rooms.append(float(FIELD.clearance[y + dy * moved, x + dx * moved]))
        if rooms[-1] == 0:
            break
    assert room_along(FIELD.clearance, x, y, dx, dy, distance) == min(rooms)


def test_signals_from_counts_and_two_prior_moves_by_hand():
    counts = np.zeros((1, N_SIGNALS, 1))
    counts[0, 1] = 6.0
    # Two prior moves are shared out over the outcomes of a context; contexts are all as likely.
    signal = move_signal(counts)
    assert np.exp(signal.log_likelihood(0, 1)) == pytest.approx((6 + 2 / N_OUTCOMES) / 8 / N_CONTEXTS)
    assert np.exp(signal.log_likelihood(0, N_OUTCOMES)) == pytest.approx(1 / N_OUTCOMES / N_CONTEXTS)
