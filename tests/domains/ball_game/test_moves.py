"""Signals of the ball game by hand and against a naive reading."""

import inspect

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.domains.ball_game import moves as ball_game_moves
from lifelore.domains.ball_game.ball_game import MOVES, ball_game, step
from lifelore.domains.ball_game.moves import (
    AFTER_EDGES,
    BEFORE_EDGES,
    FATES,
    N_AFTER,
    N_BEFORE,
    N_OUTCOMES,
    N_SIGNALS,
    move_context,
    move_fate,
    move_outcome,
    read_moves,
    room_along,
    room_class,
)
from lifelore.domains.ball_game.simulated_player import advance, new_balls, random_states

FIELD = ball_game().field
NORTH, SOUTH, EAST = 0, 1, 2


def test_classes_of_room_by_hand():
    # Edges 2, 4, 8, 16, 32, 64; an edge belongs to the class above it.
    rooms = [0, 1.9, 2, 3, 4, 63, 64, 500]
    assert [room_class(r, BEFORE_EDGES) for r in rooms] == [0, 0, 1, 1, 2, 5, 6, 6]
    assert [room_class(r, AFTER_EDGES) for r in (0, 5, 69, 70)] == [0, 2, 10, 11]


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


def test_signals_of_a_blocked_ball_by_hand():
    # Size 20 in mid corridor, 70 to the north: the way leads to 10 units from the border (room class 3 of 8 … 16).
    signals = []
    for blocked, y in (("slides", 11), ("stays", 80)):
        field = ball_game(blocked=blocked).field
        assert step(field, 3, 500, 80, NORTH, 70, 0.0, 0.999, 0.0, 0.0)[:3] == (500, y, True)
        assert move_context(field, 500, 80, NORTH, 70) == 6 * N_BEFORE + 3
        signals.append(move_outcome(field, 500, 80, NORTH, 70, 500, y))
    # One that slid 69 of 70 has made its move and has room of 11; one that stays has not, and has room of 80.
    assert signals == [0 * N_AFTER + 4, 3 * N_AFTER + 11]
    # With room of its own a smaller ball gets there: what became of the same command tells the sizes apart.
    assert step(field, 2, 500, 80, NORTH, 70, 0.0, 0.999, 0.0, 0.0)[:3] == (500, 10, False)


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


def test_signals_of_play_are_in_range_and_tell_sizes_apart():
    game = ball_game()
    kinds = np.array([0, 5]).repeat(50)
    balls = new_balls(game, kinds, 4.0, random_states(np.random.default_rng(0), 100))
    heading, before, signal = np.empty(100, np.int64), np.empty((100, 2), np.int64), np.empty(100, np.int64)
    speed, fates = np.full(100, 2), np.zeros((2, len(FATES)))
    for _ in range(40):
        advance(game.field, balls, speed, 0, 400, heading, before)
        read_moves(game.field, before, heading, speed, balls.x, balls.y, signal)
        assert signal.min() >= 0
        assert signal.max() < N_SIGNALS
        np.add.at(fates, (kinds // 5, signal % N_OUTCOMES // N_AFTER), 1)
    made = fates[:, 0] / fates.sum(axis=1)
    # 1 % and 30 % of the moves slip; 2,000 moves each, so 4 deviations are 0.9 and 4.1 points. Walls stop some
    # more.
    assert made[0] > 0.97
    assert 0.5 < made[1] < 0.75


def test_nothing_in_a_signal_depends_on_the_type():
    source = inspect.getsource(ball_game_moves)
    for hidden in ("radius", "slip", ".cost", "kind"):
        assert hidden not in source
