"""Recorded episodes of the ball game: each speed with each size, and how likely each size makes its moves."""

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import LossScale
from lifelore.interaction.signals.category_signal import CategorySignal
from reproduction.chapter4.ball_game.games import Game
from reproduction.chapter4.ball_game.moves import move_signal
from reproduction.chapter4.ball_game.play import FixedSpeeds, Ints, Moves, Players, play_all, train
from reproduction.chapter5.c5_09_switching.rounds import Recorded

GAME = "s-maze 160"
"""The default of the claims of chapter 4."""


def recorded_ball_games(n_games: int, seed: int) -> Recorded:
    """`n_games` of every pair, which pay minus the loss; moves are known from as many others."""
    game, scale = Game.parsed(GAME).game, LossScale()
    signal = move_signal(train(game, n_games, seed).signals)
    kinds, speeds = np.mgrid[: game.n_types, : game.n_speeds].reshape(2, -1).repeat(n_games, axis=1)
    players = Players.drawn(kinds, 1, stream(seed, "C5.9", "ball game"))
    recorder = MoveRecorder(speeds, signal)
    played = play_all(game, players, recorder, scale)
    shape = game.n_types, game.n_speeds, n_games
    loss = scale.loss(played.steps, played.hits)
    return Recorded(-loss.reshape(shape), recorder.log_likelihood.reshape(*shape, game.n_types))


class MoveRecorder(FixedSpeeds):
    """Sums the log likelihoods of each player's moves, (n_players, n_types)."""

    watches: ClassVar[bool] = True

    def __init__(self, speeds: Ints, signal: CategorySignal) -> None:
        super().__init__(speeds)
        self._signal = signal
        self.log_likelihood: NDArray[np.float64] = np.zeros((len(speeds), signal.n_types))

    def observe(self, speed: Ints, moves: Moves) -> None:
        rows = moves.rows
        self.log_likelihood[rows] += self._signal.log_likelihoods(speed[rows], moves.signal[rows])
