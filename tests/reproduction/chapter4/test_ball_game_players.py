"""Many players of the ball game at once, beside one alone."""

import numpy as np

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
