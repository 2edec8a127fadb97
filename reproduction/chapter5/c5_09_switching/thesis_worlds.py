"""The worlds of the thesis as `RoundWorld`: golf, telephone, surveillance, Pacman and the ball game.

What a round gains is what its policy is expected to pay: a successful call, a won game of Pacman, the pay of a
deployment. Golf and the ball game have costs: there a round gains what its policy is expected to cost less than a
policy drawn at random.
"""

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import LossScale
from lifelore.domains.golf.golf import SHOTS, Golf, category_of
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.domains.telephone.telephone import UTILITY_OF_PATH, Telephone
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.signals.category_signal import CategorySignal
from reproduction.chapter4.ball_game.games import Game
from reproduction.chapter4.ball_game.moves import move_signal
from reproduction.chapter4.ball_game.play import FixedSpeeds, Ints, Moves, Players, play_all, train
from reproduction.chapter5.c5_09_switching.pacman_games import recorded_pacman
from reproduction.chapter5.c5_09_switching.rounds import Recorded, RoundWorld, Shown
from reproduction.chapter5.c5_09_switching.small_games import win_or_not

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


Array = NDArray[np.float64]
CALLS, DEPLOYMENTS, PACMAN_GAMES, BALL_GAMES = 6, 6, 3, 3
"""Rounds of an episode; golf has the thesis's three shots."""
MODELS = 5
"""Language models; with the thesis's ten, callers differ too little to be told apart in six calls."""
MATCHED_ETA = 0.2
"""Irritation of callers with the preferred model. The thesis has 0, where a single irritation excludes a type."""
LEAST_DEVIATION = 1e-3
"""Least deviation of losses of the ball game."""


def golf() -> RoundWorld:
    """Shots at one of the training holes; the golfer hears the category of each error."""
    world = Golf()
    library = PolicyLibrary.from_means(world.mean, world.deviation, signal=CategorySignal(world.category_probs))

    def shot(generator: np.random.Generator, hole: int, club: int) -> Shown:
        error = float(world.sample_errors(generator, world.holes[hole], club))
        return Shown(int(category_of(error)), -abs(error))

    return RoundWorld(library, shot, above_random(world.mean), SHOTS)


def telephone() -> RoundWorld:
    """Calls of a user who prefers one of five language models; outcomes count the calls without irritation."""
    world = Telephone(MODELS, matched_eta=MATCHED_ETA)
    success = world.utility_probs[..., 1]
    library = PolicyLibrary(win_or_not(success), CategorySignal(world.path_probs))

    def call(generator: np.random.Generator, caller: int, model: int) -> Shown:
        path = int(world.sample(generator, caller, model))
        return Shown(path, float(UTILITY_OF_PATH[path]), score=float(path == 0))

    return RoundWorld(library, call, success, CALLS)


def surveillance() -> RoundWorld:
    """Deployments while the poachers stay at one of 68 targets; the pay is the signal."""
    world = Surveillance()
    library = PolicyLibrary.from_means(world.mean, world.deviation)

    def deployment(generator: np.random.Generator, place: int, target: int) -> Shown:
        pay = float(world.mean[place, target] + world.deviation * generator.standard_normal())
        return Shown(pay, pay)

    return RoundWorld(library, deployment, world.mean, DEPLOYMENTS)


def pacman(n_games: int, n_training: int, seed: int) -> RoundWorld:
    """Games against a ghost of one of four strategies; a policy is learnt for each."""
    games = recorded_pacman(n_games, n_training, seed)
    won = games.pay.mean(axis=2)
    library = PolicyLibrary(win_or_not(won), games.signal())
    return RoundWorld(library, games.round_of, won, PACMAN_GAMES)


def ball_game(n_games: int, seed: int) -> RoundWorld:
    """Episodes of a player with a ball of one of six sizes, at one of five speeds."""
    games = recorded_ball_games(n_games, seed)
    mean, deviation = games.pay.mean(axis=2), games.pay.std(axis=2)
    library = PolicyLibrary.from_means(mean, np.maximum(deviation, LEAST_DEVIATION), signal=games.signal())
    return RoundWorld(library, games.round_of, above_random(mean), BALL_GAMES)


def above_random(mean: Array) -> Array:
    """What each policy pays more than a policy drawn at random does, (T, P)."""
    return mean - mean.mean(axis=1, keepdims=True)
