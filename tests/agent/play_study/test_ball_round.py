"""A round of the ball game by frames: against the batched game, and by hand."""

import numpy as np
import pytest

from lifelore.agent.play_study.ball_round import BallRound
from lifelore.agent.play_study.scripted_player import heading_of_script
from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SPEEDS, ball_game
from lifelore.domains.ball_game.moves import N_SIGNALS, read_moves

GAME = ball_game()


def new_round(kind: int = 3, sigma: float = 4.0) -> BallRound:
    return BallRound(GAME, kind, sigma, stream(1, "test"))


def test_signals_are_those_of_the_batched_reader():
    played, before = new_round(), []
    while not played.over:
        before.append((played.x, played.y))
        played.steer(heading_of_script(played))
        played.move(len(played.moves) % len(SPEEDS))
    table = played.table
    signal = np.empty(len(table), np.int64)
    heading, speed, x, y = (np.ascontiguousarray(table[:, i]) for i in (2, 3, 0, 1))
    read_moves(GAME.field, np.array(before), heading, speed, x, y, signal)
    assert table[:, 5].tolist() == signal.tolist()
    assert signal.min() >= 0
    assert signal.max() < N_SIGNALS
    assert played.reached
    assert played.hits == table[:, 4].sum()


def test_without_noise_the_ball_goes_straight_by_its_speed():
    played = BallRound(GAME, 0, 0.0, stream(3, "test"))
    x, y = played.x, played.y
    played.steer(2)
    played.move(SPEEDS.index(50))
    assert (played.x, played.y) == (x + 50, y)
    assert played.place_at(0.5) == (x + 25, y)


def test_a_ball_that_goes_into_a_wall_collides_and_never_arrives():
    played = new_round(kind=0, sigma=0.0)
    played.steer(0)
    while not played.over:
        played.move(0)
    assert not played.reached
    assert len(played.moves) == 400
    assert played.hits > 380  # each move goes into the wall but for slips, 1 % of the moves
    assert played.loss == pytest.approx(1 + played.hits / 20)


@pytest.mark.parametrize("heading", [-1, 4, "north", None, True, 1.0])
def test_a_wrong_direction_changes_nothing(heading):
    played = new_round()
    played.steer(1)
    with pytest.raises(InputError, match="heading"):
        played.steer(heading)
    assert played.heading == 1


def test_a_move_needs_a_direction():
    with pytest.raises(InputError, match="direction"):
        new_round().move(0)
