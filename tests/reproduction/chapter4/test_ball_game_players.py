"""Many players of the ball game at once, beside one alone, and compiled beside plain Python."""

import os
import subprocess
import sys

import numpy as np
import pytest

from lifelore.domains.ball_game.ball_game import ball_game
from reproduction.chapter4.ball_game.players import advance, new_balls, random_states

GAME = ball_game()
FIELD = GAME.field


def test_many_players_move_as_one_would():
    generator = np.random.default_rng(3)
    kinds = np.array([0, 3, 5, 2])
    random = random_states(generator, 4)
    together = new_balls(GAME, kinds, [0.3, 2.0, 5.0, 8.0], random)
    speed = np.array([0, 2, 4, 1])
    heading, before = np.empty(4, np.int64), np.empty((4, 2), np.int64)
    for _ in range(30):
        advance(FIELD, together, speed, heading, before)
    for i in range(4):
        alone = new_balls(GAME, kinds[i : i + 1], together.sigma[i], random[i : i + 1])
        for _ in range(30):
            advance(FIELD, alone, speed[i : i + 1], heading, before)
        assert (alone.x[0], alone.y[0]) == (together.x[i], together.y[i])
        assert alone.hits[0] == together.hits[i]


PLAIN = """
import numpy as np
from lifelore.domains.ball_game.ball_game import ball_game
from reproduction.chapter4.ball_game.moves import read_moves
from reproduction.chapter4.ball_game.players import advance, new_balls, random_states
for blocked in ("slides", "stays"):
    field = ball_game(blocked=blocked).field
    random = random_states(np.random.default_rng(1), 6)
    balls = new_balls(ball_game(blocked=blocked), range(6), 6.0, random)
    heading, before, signal = np.empty(6, np.int64), np.empty((6, 2), np.int64), np.empty(6, np.int64)
    for _ in range(60):
        speed = np.array([0, 1, 2, 3, 4, 4])
        advance(field, balls, speed, heading, before)
        read_moves(field, before, heading, speed, balls.x, balls.y, signal)
        print(heading.tolist(), balls.x.tolist(), balls.y.tolist(), balls.hits.tolist(), signal.tolist())
"""


@pytest.mark.slow
def test_compiled_and_plain_python_agree():
    def said(disabled):
        command = [sys.executable, "-W", "error", "-c", PLAIN]
        environment = os.environ | {"NUMBA_DISABLE_JIT": disabled}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout.splitlines()

    compiled = said("0")
    assert len(compiled) == 120
    assert compiled[:60] != compiled[60:]
    assert compiled == said("1")
